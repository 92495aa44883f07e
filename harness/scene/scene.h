#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "common/scene_types.h"
#include "scene/camera.h"
#include "scene/camera_path.h"

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

/// The alpha of a fragment is the product of baseColor.a, the texture's alpha and the vertex
/// colour's alpha, without the factors that the material ignores. A fragment with less alpha than
/// the cutoff is discarded, whatever the mode is. Of the others, those of OPAQUE and MASK materials
/// are drawn with alpha 1, and those of BLEND materials are blended.
struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f};  ///< linear, alpha = opacity, not premultiplied; 1 when OPAQUE
  int texture = -1;           ///< index into Scene::textures, -1 for none
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.0f;  ///< 0: nothing is discarded; a BLEND material may have one too
  bool doubleSided = true;
  bool ignoreVertexAlpha = false;  ///< OPAQUE materials, and all under an opacity override
  bool ignoreTextureAlpha =
      false;  ///< the material was OPAQUE in its file, where this alpha has no meaning
};

/// A fault in the input that was repaired, and how often.
struct Repair {
  std::string what;  ///< "triangles with non-finite positions dropped"
  std::uint64_t count = 0;
};

/// A scene in main memory. Loaders and generators make it, and it is uploaded to the device. The
/// index of a triangle in `triangles` is its primitive id. Ties in depth are broken by it, in
/// whatever order the triangles are submitted.
struct Scene {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<glm::uvec3> triangles;
  std::vector<Material> materials;  ///< never empty when there are triangles
  std::vector<Texture> textures;
  std::map<std::string, Camera> views;      ///< at least "default"
  std::map<std::string, CameraPath> paths;  ///< fly-throughs
  std::vector<Repair> repairs;
  Bounds bounds;  ///< of the vertices that triangles use

  /// Adds `count` to the repair of that name. A count of 0 adds no repair.
  void repaired(const std::string& what, std::uint64_t count = 1);

  AlphaMode alphaModeOf(const glm::uvec3& triangle) const {
    return materials[vertices[triangle.x].material].alphaMode;
  }
};

/// The scene that the user asks for: a generated scene's name or a path, and the settings that
/// change its content.
struct SceneSpec {
  std::string source;            ///< "boxes", "../shared/scenes/sponza.glb"
  std::optional<float> opacity;  ///< in (0, 1]: see overrideOpacity()
  float detail = 1.0f;           ///< generated scenes: (0, 1], share of the full triangle count
  bool allowOutside = false;     ///< the file may name files outside its folder
  bool operator==(const SceneSpec&) const = default;
};

/// One entry of `oitlab list scenes`.
struct SceneInfo {
  std::string name;
  std::string summary;  ///< one line
};

/// The generated scenes, in the order in which they are listed.
std::vector<SceneInfo> sceneCatalogue();

/// The size of a generated scene.
struct SceneSize {
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t quads = 0, degenerateQuads = 0;  ///< see scene/quads.h; 0 unless `detail` is 1
  std::size_t materials = 0, textures = 0;
  std::vector<std::string> views, paths;
};

/// The size of the scene that loadScene() makes. It is counted without making the scene, so it is
/// fast even for millions of triangles. `detail` in (0, 1]. Throws InputError when no generated
/// scene has that name.
SceneSize generatedSize(const std::string& name, float detail = 1.0f);

/// Loads or generates a scene, applies the opacity override, computes the bounds and adds the
/// views; "default" always exists. Throws InputError with file, place, what was found and what was
/// expected; for an unknown name with a suggestion.
Scene loadScene(const SceneSpec& spec);

/// Makes every material BLEND with `opacity` in (0, 1] as baseColor.a. Vertex alpha is ignored. The
/// alpha of textures counts unless the material was OPAQUE. Texels that a MASK material cut out
/// stay cut out: the cutoff is scaled by the change of baseColor.a.
void overrideOpacity(Scene& scene, float opacity);

/// The camera of `view`: the name of one of the scene's views, "path:NAME@T" for the camera at T in
/// [0, 1] of one of its paths, or a text for parseCamera(). Throws InputError with the known names
/// and a suggestion.
Camera findView(const Scene& scene, const std::string& view);

/// The octahedral packing of a unit normal for Vertex::normal, and back.
std::uint32_t packNormal(glm::vec3 unitNormal);
glm::vec3 unpackNormal(std::uint32_t packed);

/// Linear RGBA in [0, 1] as Vertex::color, rounded to nearest.
std::uint32_t packColor(glm::vec4 linear);

/// Recomputes `scene.bounds` from the vertices that triangles use.
void computeBounds(Scene& scene);

}  // namespace oitlab
