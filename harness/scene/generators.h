#pragma once

#include <span>

#include "scene/scene.h"

// The generated scenes, in the order in which they are listed. To add one: a file generate_NAME.cpp
// that defines `const GeneratedScene NAME` in namespace oitlab::generated, and its name here.
#define OITLAB_GENERATED_SCENES(X) \
  X(boxes)                         \
  X(planes)                        \
  X(teapot)

namespace oitlab {

/// A scene made by code: the same on every machine, since a paper's figure may rest on it.
struct GeneratedScene {
  const char* name;
  const char* summary;  ///< one line, with the triangle count at full detail

  /// `detail` in (0, 1] is the share of the full triangle count to aim at.
  Scene (*make)(float detail);
};

namespace generated {
#define OITLAB_DECLARE(name) extern const GeneratedScene name;
OITLAB_GENERATED_SCENES(OITLAB_DECLARE)
#undef OITLAB_DECLARE
}  // namespace generated

/// All of them.
std::span<const GeneratedScene* const> generatedScenes();

}  // namespace oitlab
