#include <algorithm>
#include <cmath>
#include <span>

#include "scene/import/gltf_parts.h"
#include "scene/import/texture_file.h"
#include "util/error.h"
#include "util/parallel.h"

namespace oitlab {
namespace {

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number(const tinygltf::Value& object, const char* key, double otherwise) {
  const tinygltf::Value& value = object.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

glm::vec2 pair(const tinygltf::Value& object, const char* key, glm::vec2 otherwise) {
  const tinygltf::Value& value = object.Get(key);
  if (!value.IsArray() || value.ArrayLen() != 2) return otherwise;
  return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
}

float share(double value) {  // NaN becomes 0
  return value > 0.0 ? float(std::min(value, 1.0)) : 0.0f;
}

// The KHR_texture_transform of a texture reference, as the matrix of its specification.
void readUvTransform(const tinygltf::TextureInfo& info, GltfMaterial& material) {
  material.texCoord = std::max(info.texCoord, 0);
  const tinygltf::Value* transform = extension(info.extensions, "KHR_texture_transform");
  if (!transform) return;
  material.texCoord = std::max(int(number(*transform, "texCoord", material.texCoord)), 0);
  const glm::vec2 offset = pair(*transform, "offset", glm::vec2(0.0f));
  const glm::vec2 scale = pair(*transform, "scale", glm::vec2(1.0f));
  const float angle = float(number(*transform, "rotation", 0.0));
  const float c = std::cos(angle), s = std::sin(angle);
  material.uvTransform = glm::mat3x2(glm::vec2(c, -s) * scale.x, glm::vec2(s, c) * scale.y, offset);
}

Material readMaterial(const tinygltf::Material& from) {
  Material material{.name = from.name, .doubleSided = from.doubleSided};
  const std::vector<double>& factor = from.pbrMetallicRoughness.baseColorFactor;
  for (int i = 0; i < 4 && factor.size() == 4; ++i)
    material.baseColor[i] = share(factor[std::size_t(i)]);
  if (from.alphaMode == "BLEND") {
    material.alphaMode = AlphaMode::blend;
  } else if (from.alphaMode == "MASK") {
    material.alphaMode = AlphaMode::mask;
    material.alphaCutoff = std::isfinite(from.alphaCutoff) ? float(from.alphaCutoff) : 0.5f;
  } else {
    material.baseColor.a = 1.0f;
    material.ignoreVertexAlpha = material.ignoreTextureAlpha = true;
  }
  if (const auto* glass = extension(from.extensions, "KHR_materials_transmission")) {
    const float transmission = share(number(*glass, "transmissionFactor", 0.0));
    if (transmission > 0.0f) {
      const float opacity = 1.0f - transmission;  // see gltf.h
      material.baseColor.a *= opacity;
      material.alphaCutoff *= opacity;
      material.alphaMode = AlphaMode::blend;
    }
  }
  return material;
}

// The encoded bytes of an image, from a buffer view, a data URI or a file. Empty when it is
// missing.
std::span<const unsigned char> encodedImage(const GltfFile& file, const tinygltf::Image& image) {
  if (image.bufferView >= 0) return gltfBytes(file, image.bufferView, file.path);
  return image.image;
}

// The image of a material's base colour; -1 when it has none, -2 when its image is missing.
int imageOf(const tinygltf::Model& model, const tinygltf::Material& material) {
  const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
  if (texture < 0) return -1;
  if (std::size_t(texture) >= model.textures.size()) return -2;
  const int image = model.textures[std::size_t(texture)].source;
  return image >= 0 && std::size_t(image) < model.images.size() ? image : -2;
}

// Decodes each image that a base colour uses once. Returns the texture of each image, -1 for none.
std::vector<int> readTextures(const GltfFile& file, Scene& scene) {
  const auto& images = file.model.images;
  std::vector<int> textureOf(images.size(), -1);
  std::vector<std::size_t> used;
  for (const tinygltf::Material& material : file.model.materials)
    if (const int image = imageOf(file.model, material); image >= 0) used.push_back(image);
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());

  for (const std::size_t image : used)
    file.budget.addTexels(countTexels(encodedImage(file, images[image])),
                          fmt::format("image {} '{}'", image, images[image].name));
  std::vector<Texture> decoded(used.size());
  std::vector<char> good(used.size());
  parallelFor(used.size(), [&](std::size_t i) {
    const tinygltf::Image& image = images[used[i]];
    decoded[i].name = !image.name.empty() ? image.name : fmt::format("image {}", used[i]);
    good[i] = decodeTexture(encodedImage(file, image), decoded[i]);
  });
  for (std::size_t i = 0; i < used.size(); ++i)
    if (good[i]) {
      textureOf[used[i]] = int(scene.textures.size());
      scene.textures.push_back(std::move(decoded[i]));
    }
  return textureOf;
}

}  // namespace

std::vector<GltfMaterial> readGltfMaterials(const GltfFile& file, Scene& scene) {
  const std::vector<int> textureOf = readTextures(file, scene);
  std::vector<GltfMaterial> materials;
  for (const tinygltf::Material& from : file.model.materials) {
    GltfMaterial& material = materials.emplace_back();
    material.index = std::uint32_t(scene.materials.size());
    scene.materials.push_back(readMaterial(from));
    readUvTransform(from.pbrMetallicRoughness.baseColorTexture, material);
    const int image = imageOf(file.model, from);
    int& texture = scene.materials.back().texture;
    texture = image >= 0 ? textureOf[std::size_t(image)] : -1;
    if (image != -1 && texture == -1)
      scene.repaired("materials drawn without their texture, which is missing or unreadable");
  }
  materials.push_back({.index = std::uint32_t(scene.materials.size())});
  const auto plain = [](const tinygltf::Primitive& primitive) { return primitive.material < 0; };
  for (const tinygltf::Mesh& mesh : file.model.meshes)
    if (std::ranges::any_of(mesh.primitives, plain)) {
      tinygltf::Material from;
      from.name = "default";
      scene.materials.push_back(readMaterial(from));
      break;
    }
  return materials;
}

}  // namespace oitlab
