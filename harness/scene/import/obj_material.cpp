#include "scene/import/obj_material.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "scene/import/texture_file.h"

namespace oitlab {
namespace {

float share(float value) {  // NaN becomes 0
  return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

// Files that were written on Windows have backslashes in their paths.
std::string localPath(std::string name) {
  std::ranges::replace(name, '\\', '/');
  return name;
}

// Copies the mask to the alpha of `color`: the mask's alpha if it has one, else its red channel.
void applyMask(const Texture& mask, Texture& color) {
  const std::size_t channel = mask.hasAlpha() ? 3 : 0;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      const std::size_t fromX = std::size_t(x) * std::size_t(mask.width) / std::size_t(color.width);
      const std::size_t fromY =
          std::size_t(y) * std::size_t(mask.height) / std::size_t(color.height);
      color.rgba[4 * (std::size_t(y) * std::size_t(color.width) + std::size_t(x)) + 3] =
          mask.rgba[4 * (fromY * std::size_t(mask.width) + fromX) + channel];
    }
}

}  // namespace

std::string ObjLibrary::beside(const std::string& file) const {
  return file.empty() ? "" : (name.parent_path() / localPath(file)).string();
}

ObjLibrary readObjLibrary(const std::string& name, SceneFolder& folder) {
  ObjLibrary library{.name = localPath(name)};
  std::ifstream stream(folder.find(library.name.string()));
  if (!stream) return library;
  library.found = true;
  std::string warning, error;
  tinyobj::LoadMtl(&library.indices, &library.materials, &stream, &warning, &error);
  library.hasErrors = !error.empty();
  return library;
}

int ObjMaterials::readTextures(const std::string& color, const std::string& alpha) {
  if (color.empty() && alpha.empty()) return -1;
  const auto [known, fresh] = textures_.try_emplace(color + "\n" + alpha, -1);
  if (!fresh) return known->second;
  Texture texture, mask;
  const bool hasColor = !color.empty() && readTexture(folder_.find(color), texture, budget_);
  const bool hasMask = !alpha.empty() && readTexture(folder_.find(alpha), mask, budget_);
  scene_.repaired(
      "textures left out, which are missing or unreadable",
      std::uint64_t(!color.empty() && !hasColor) + std::uint64_t(!alpha.empty() && !hasMask));
  if (!hasColor && !hasMask) return -1;
  if (!hasColor) {  // white, with the mask as alpha
    texture = {.name = mask.name, .width = mask.width, .height = mask.height};
    texture.rgba.assign(mask.rgba.size(), 255);
  }
  if (hasMask) applyMask(mask, texture);
  scene_.textures.push_back(std::move(texture));
  return known->second = int(scene_.textures.size()) - 1;
}

void ObjMaterials::readLibrary(const std::string& name) {
  const ObjLibrary library = readObjLibrary(name, folder_);
  if (!library.found)
    return scene_.repaired("material libraries left out, which are missing or unreadable");
  if (library.hasErrors) scene_.repaired("material libraries with errors, read as far as possible");
  for (const auto& [materialName, index] : library.indices) {
    if (index < 0 || std::size_t(index) >= library.materials.size()) continue;
    const tinyobj::material_t& from = library.materials[std::size_t(index)];
    Material material{.name = materialName};
    for (int i = 0; i < 3; ++i) material.baseColor[i] = share(from.diffuse[i]);
    material.baseColor.a = share(from.dissolve);
    // Some exporters write a black Kd beside a texture, which is to be ignored.
    if (!from.diffuse_texname.empty() && glm::vec3(material.baseColor) == glm::vec3(0.0f))
      material.baseColor = glm::vec4(1.0f, 1.0f, 1.0f, material.baseColor.a);
    material.texture =
        readTextures(library.beside(from.diffuse_texname), library.beside(from.alpha_texname));
    const bool clear =
        material.texture >= 0 && scene_.textures[std::size_t(material.texture)].hasAlpha();
    if (material.baseColor.a < 1.0f || clear) {
      material.alphaMode = AlphaMode::blend;
    } else {
      material.ignoreVertexAlpha = material.ignoreTextureAlpha = true;
    }
    byName_.insert_or_assign(materialName, std::uint32_t(scene_.materials.size()));
    scene_.materials.push_back(std::move(material));
  }
}

std::uint32_t ObjMaterials::find(const std::string& name) {
  if (const auto known = byName_.find(name); known != byName_.end()) return known->second;
  if (!name.empty()) scene_.repaired("materials that do not exist replaced by a grey one");
  const auto index = std::uint32_t(scene_.materials.size());
  scene_.materials.push_back({.name = name.empty() ? "default" : name,
                              .baseColor = {0.8f, 0.8f, 0.8f, 1.0f},
                              .ignoreVertexAlpha = true,
                              .ignoreTextureAlpha = true});
  byName_.emplace(name, index);
  return index;
}

}  // namespace oitlab
