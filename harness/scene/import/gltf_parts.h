#pragma once

// What the files of the glTF loader share; nobody else includes it.

#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>
#include <glm/glm.hpp>

#include "scene/scene.h"

namespace oitlab {

/// A file being read.
struct GltfFile {
  std::string path;  ///< for messages
  tinygltf::Model model;
};

/// What a primitive needs to know of its material.
struct GltfMaterial {
  std::uint32_t index = 0;        ///< into Scene::materials
  int texCoord = 0;               ///< the set of texture coordinates that the base colour uses
  glm::mat3x2 uvTransform{1.0f};  ///< KHR_texture_transform: uv' = uvTransform * (u, v, 1)
};

/// A range-checked view of an accessor: no index below `count` reads outside its buffer.
class GltfAccessor {
 public:
  /// `place` begins messages: "x.glb: mesh 3, primitive 0, POSITION".
  GltfAccessor(const GltfFile& file, int accessor, const std::string& place);

  std::size_t count() const { return count_; }
  int components() const { return components_; }

  /// A component as float; integers are scaled to [0, 1] or [-1, 1] when the accessor says that
  /// they are normalised, or `normalize` does.
  float number(std::size_t element, int component, bool normalize = false) const;

  glm::vec2 vec2(std::size_t i) const { return {number(i, 0), number(i, 1)}; }
  glm::vec3 vec3(std::size_t i) const { return {number(i, 0), number(i, 1), number(i, 2)}; }

  /// The indices of a primitive: all elements, each checked to be below `limit`.
  std::vector<std::uint32_t> indices(std::size_t limit) const;

 private:
  std::string place_;
  const unsigned char* data_ = nullptr;  // nullptr: all zero
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  int componentType_ = 0;
  int components_ = 0;
  bool normalized_ = false;
};

/// The bytes of a buffer view; throws InputError when it is not within its buffer.
std::span<const unsigned char> gltfBytes(const GltfFile& file, int bufferView,
                                         const std::string& place);

/// Appends the file's materials and the textures that they use to `scene`. Returns one per material
/// of the file, in its order, and last that of primitives that name none.
std::vector<GltfMaterial> readGltfMaterials(const GltfFile& file, Scene& scene);

/// Appends a primitive's triangles and vertices, moved by `world`.
void readGltfPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive,
                       const glm::dmat4& world, const GltfMaterial& material,
                       const std::string& place, Scene& scene);

}  // namespace oitlab
