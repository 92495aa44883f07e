#pragma once

#include <cstdint>
#include <span>

#include "scene/generate/mesh_builder.h"
#include "scene/scene.h"

// The generated scenes, in the order in which they are listed. To add one, add its name here and
// write a file NAME.cpp in this folder that defines `const GeneratedScene NAME` in namespace
// oitlab::generated.
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

/// A scene that code makes. It is the same on every machine, because figures of the papers depend
/// on it.
struct GeneratedScene {
  const char* name;
  const char* summary;  ///< one line, with the triangle count at full detail

  /// Makes the scene, or counts it if the builder is a counting one. `detail` in (0, 1] is the
  /// share of the full triangle count to aim at.
  void (*build)(MeshBuilder& builder, float detail);
};

namespace generated {
#define OITLAB_DECLARE(name) extern const GeneratedScene name;
OITLAB_GENERATED_SCENES(OITLAB_DECLARE)
#undef OITLAB_DECLARE
}  // namespace generated

/// All generated scenes.
std::span<const GeneratedScene* const> generatedScenes();

/// The scene of that name; null when there is none.
const GeneratedScene* findGenerated(const std::string& name);

/// Builds `structure` with the fineness, between 0.001 and 1000, at which its number of triangles
/// is nearest to `triangles`. The number must not fall when the fineness grows. At 1 the structure
/// has the numbers that are written in it.
void buildToCount(MeshBuilder& builder, double triangles,
                  void (*structure)(MeshBuilder& builder, float fineness));

/// round(count * fineness), at least `least`: how often a structure repeats a part.
int scaledCount(float count, float fineness, int least);

}  // namespace oitlab
