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

/// The alpha of a fragment is baseColor.a times the texture's alpha times the vertex colour's, less
/// the factors that are to be ignored. A fragment with less alpha than the cutoff is discarded,
/// whatever the mode; of the others, OPAQUE and MASK ones are drawn with alpha 1, BLEND ones blend.
struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f};  ///< linear, alpha = opacity, not premultiplied; 1 when OPAQUE
  int texture = -1;           ///< index into Scene::textures, -1 for none
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.0f;  ///< 0: nothing is discarded; a BLEND material may have one too
  bool doubleSided = true;
  bool ignoreVertexAlpha = false;   ///< OPAQUE materials, and all under an opacity override
  bool ignoreTextureAlpha = false;  ///< OPAQUE in its origin: the texture's alpha means nothing
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
  std::map<std::string, Camera> views;      ///< at least "default"
  std::map<std::string, CameraPath> paths;  ///< fly-throughs
  std::vector<Repair> repairs;
  Bounds bounds;  ///< of the vertices that triangles use

  /// Adds to the repair of that name, or makes it. A count of 0 is no repair.
  void repaired(const std::string& what, std::uint64_t count = 1);

  AlphaMode alphaModeOf(const glm::uvec3& triangle) const {
    return materials[vertices[triangle.x].material].alphaMode;
  }
};

/// What the user asks for: a name of the catalogue or a path, with the knobs that change its
/// content.
struct SceneSpec {
  std::string source;            ///< "boxes", "../shared/scenes/sponza.glb"
  std::optional<float> opacity;  ///< in (0, 1]: see overrideOpacity()
  float detail = 1.0f;           ///< generated scenes: (0, 1], share of the full triangle count
  bool operator==(const SceneSpec&) const = default;
};

/// One entry of `oitlab list scenes`.
struct SceneInfo {
  std::string name;
  std::string summary;  ///< one line
};

/// The generated scenes, in the order in which they are listed.
std::vector<SceneInfo> sceneCatalogue();

/// How big a generated scene is.
struct SceneSize {
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t quads = 0, degenerateQuads = 0;  ///< of scene/quads.h; 0 unless `detail` is 1
  std::size_t materials = 0, textures = 0;
  std::vector<std::string> views, paths;
};

/// The size that loadScene() would find, counted without making the scene: quick even for millions
/// of triangles. `detail` in (0, 1]. Throws InputError when no generated scene has that name.
SceneSize generatedSize(const std::string& name, float detail = 1.0f);

/// Loads or generates a scene, applies the opacity override, computes bounds, and fills in the
/// views: "default" always exists. Throws InputError (file, place, what was found and wanted; an
/// unknown name gets a suggestion).
Scene loadScene(const SceneSpec& spec);

/// Every material becomes BLEND with `opacity` in (0, 1] as its baseColor.a, and vertex alpha is
/// ignored; the alpha of textures counts unless the material was OPAQUE. What a MASK material cut
/// out stays cut out: its cutoff is scaled by the change of baseColor.a.
void overrideOpacity(Scene& scene, float opacity);

/// The camera for `view`: a named view of the scene, "path:NAME@T" for the camera at T in [0, 1] of
/// one of its paths, or what parseCamera() takes. Throws InputError with the names there are and a
/// suggestion.
Camera findView(const Scene& scene, const std::string& view);

/// Octahedral packing of a unit normal as Vertex::normal wants it, and back.
std::uint32_t packNormal(glm::vec3 unitNormal);
glm::vec3 unpackNormal(std::uint32_t packed);

/// Linear RGBA in [0, 1] to Vertex::color, rounded to nearest.
std::uint32_t packColor(glm::vec4 linear);

/// Recomputes `scene.bounds` from the vertices that triangles use.
void computeBounds(Scene& scene);

}  // namespace oitlab
