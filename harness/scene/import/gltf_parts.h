#pragma once

// Shared by the files of the glTF loader. No other file includes it.

#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>
#include <glm/glm.hpp>

#include "scene/import/budget.h"
#include "scene/scene.h"

namespace oitlab {

/// A file being read.
struct GltfFile {
  std::string path;     ///< for messages
  SceneBudget& budget;  ///< asked before what the file wants is allocated
  tinygltf::Model model;
};

/// The properties of a material that a primitive needs.
struct GltfMaterial {
  std::uint32_t index = 0;        ///< into Scene::materials
  int texCoord = 0;               ///< the set of texture coordinates that the base colour uses
  glm::mat3x2 uvTransform{1.0f};  ///< KHR_texture_transform: uv' = uvTransform * (u, v, 1)
};

/// A range-checked view of an accessor: an index below `count` never reads outside its buffer.
class GltfAccessor {
 public:
  /// Messages start with `place`: "x.glb: mesh 3, primitive 0, POSITION".
  GltfAccessor(const GltfFile& file, int accessor, const std::string& place);

  std::size_t count() const { return count_; }
  int components() const { return components_; }

  /// A component as a float. Integers are scaled to [0, 1] or [-1, 1] if the accessor or
  /// `normalize` says that they are normalised.
  float number(std::size_t element, int component, bool normalize = false) const;

  glm::vec2 vec2(std::size_t i) const { return {number(i, 0), number(i, 1)}; }
  glm::vec3 vec3(std::size_t i) const { return {number(i, 0), number(i, 1), number(i, 2)}; }

  /// All elements as the indices of a primitive. Each is checked to be below `limit`.
  std::vector<std::uint32_t> indices(std::size_t limit) const;

 private:
  std::string place_;
  const unsigned char* data_ = nullptr;  // null: all elements are zero
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  int componentType_ = 0;
  int components_ = 0;
  bool normalized_ = false;
};

/// The bytes of a buffer view. Throws InputError when it is not inside its buffer.
std::span<const unsigned char> gltfBytes(const GltfFile& file, int bufferView,
                                         const std::string& place);

/// Appends the file's materials and the textures that they use to `scene`. Returns one element per
/// material of the file, in its order, and at the end one for primitives without a material.
std::vector<GltfMaterial> readGltfMaterials(const GltfFile& file, Scene& scene);

/// Appends a primitive's triangles and vertices, transformed by `world`.
void readGltfPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive,
                       const glm::dmat4& world, const GltfMaterial& material,
                       const std::string& place, Scene& scene);

}  // namespace oitlab
