#pragma once

#include <cstdint>
#include <span>

#include "scene/generate/mesh_builder.h"
#include "scene/scene.h"

// The generated scenes, in the order in which they are listed. To add one: a file NAME.cpp here
// that defines `const GeneratedScene NAME` in namespace oitlab::generated, and its name here.
#define OITLAB_GENERATED_SCENES(X) \
  X(boxes)                         \
  X(bunny)                         \
  X(conference)                    \
  X(dragon)                        \
  X(gallery)                       \
  X(hairball)                      \
  X(planes)                        \
  X(powerplant)                    \
  X(sanmiguel)                     \
  X(scrubpine)                     \
  X(smoke)                         \
  X(sponza_like)                   \
  X(teapot)                        \
  X(whiteoak)

namespace oitlab {

/// A scene made by code: the same on every machine, since a paper's figure may rest on it.
struct GeneratedScene {
  const char* name;
  const char* summary;  ///< one line, with the triangle count at full detail

  /// Makes it, or counts it when the builder counts. `detail` in (0, 1] is the share of the full
  /// triangle count to aim at.
  void (*build)(MeshBuilder& builder, float detail);
};

namespace generated {
#define OITLAB_DECLARE(name) extern const GeneratedScene name;
OITLAB_GENERATED_SCENES(OITLAB_DECLARE)
#undef OITLAB_DECLARE
}  // namespace generated

/// All of them.
std::span<const GeneratedScene* const> generatedScenes();

/// The scene of that name, nullptr when there is none.
const GeneratedScene* findGenerated(const std::string& name);

/// Builds `structure` into `builder` with the fineness at which it has about `triangles` triangles:
/// the nearest there is between 0.001 and 1000.
/// `structure` must not get fewer triangles as the fineness grows; 1 is what its numbers are for.
void buildToCount(MeshBuilder& builder, double triangles,
                  void (*structure)(MeshBuilder& builder, float fineness));

/// round(count * fineness), at least `least`: how structures divide and repeat.
int scaledCount(float count, float fineness, int least);

}  // namespace oitlab
