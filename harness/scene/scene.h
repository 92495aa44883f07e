#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "common/scene_types.h"
#include "scene/camera.h"

namespace oitlab {

enum class AlphaMode : std::uint32_t {
  opaque = ALPHA_OPAQUE,
  mask = ALPHA_MASK,
  blend = ALPHA_BLEND
};

/// A decoded base-colour texture: RGBA8, rows top to bottom, colour sRGB-encoded, alpha linear.
struct Texture {
  std::string name;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4 bytes
  bool hasAlpha() const;           ///< any texel with alpha < 255
};

struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f};  ///< linear, alpha = opacity, not premultiplied
  int texture = -1;           ///< index into Scene::textures, -1 for none
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = true;
};

/// Something found wrong in the input that could be mended, with how often it was.
struct Repair {
  std::string what;  ///< "triangles with non-finite positions dropped"
  std::uint64_t count = 0;
};

/// A scene in main memory: what loaders and generators make, and what is uploaded to the device.
/// The index of a triangle in `triangles` is its primitive id: ties in depth are broken by it,
/// however the triangles are submitted.
struct Scene {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<glm::uvec3> triangles;
  std::vector<Material> materials;  ///< never empty when there are triangles
  std::vector<Texture> textures;
  std::map<std::string, Camera> views;  ///< at least "default"
  std::vector<Repair> repairs;
  Bounds bounds;  ///< of the vertices that triangles use

  AlphaMode alphaModeOf(const glm::uvec3& triangle) const {
    return materials[vertices[triangle.x].material].alphaMode;
  }
};

/// What the user asks for: a name of the catalogue or a path, with the knobs that change its
/// content.
struct SceneSpec {
  std::string source;            ///< "boxes", "../shared/scenes/sponza.glb"
  std::optional<float> opacity;  ///< override in (0, 1]: every material blends with this opacity
  float detail = 1.0f;           ///< generated scenes: (0, 1], share of the full triangle count
};

/// One entry of `oitlab list scenes`.
struct SceneInfo {
  std::string name;
  std::string summary;  ///< one line
};

/// The generated scenes, in the order in which they are listed.
std::vector<SceneInfo> sceneCatalogue();

/// Loads or generates a scene, applies the opacity override, computes bounds, and fills in the
/// views: "default" always exists. Throws InputError (file, place, what was found and wanted; an
/// unknown name gets a suggestion).
Scene loadScene(const SceneSpec& spec);

/// The camera for `view`: a named view of the scene, or what parseCamera() takes. Throws InputError
/// with the scene's view names and a suggestion.
Camera findView(const Scene& scene, const std::string& view);

/// Octahedral packing of a unit normal as Vertex::normal wants it, and back.
std::uint32_t packNormal(glm::vec3 unitNormal);
glm::vec3 unpackNormal(std::uint32_t packed);

/// Linear RGBA in [0, 1] to Vertex::color, rounded to nearest.
std::uint32_t packColor(glm::vec4 linear);

/// Recomputes `scene.bounds` from the vertices that triangles use.
void computeBounds(Scene& scene);

}  // namespace oitlab
