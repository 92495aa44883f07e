// Files of scenes: glTF and GLB, OBJ with its MTL, textures, and the cache of quads.
#include <fstream>
#include <stdexcept>

#include "fuzz/targets.h"
#include "scene/import/texture_file.h"
#include "scene/quads.h"
#include "scene/scene.h"

namespace oitlab {
namespace {

std::filesystem::path writeFile(const std::string& name, std::string_view bytes) {
  auto path = fuzzFolder() / name;
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  return path;
}

/// What every loaded scene must keep, since the device reads its buffers by these indices.
void checkScene(const Scene& scene) {
  for (const glm::uvec3& t : scene.triangles)
    for (const std::uint32_t vertex : {t.x, t.y, t.z}) {
      if (vertex >= scene.vertices.size()) throw std::logic_error("vertex index out of range");
      if (scene.vertices[vertex].material >= scene.materials.size())
        throw std::logic_error("material index out of range");
    }
  for (const Material& material : scene.materials)
    if (material.texture < -1 || material.texture >= int(scene.textures.size()))
      throw std::logic_error("texture index out of range");
  for (const Texture& texture : scene.textures)
    if (texture.rgba.size() != std::size_t(texture.width) * std::size_t(texture.height) * 4)
      throw std::logic_error("a texture of another size than it says");
}

void loadAndCheck(const std::filesystem::path& path) {
  parseOrRefuse([&] {
    const Scene scene = loadScene({.source = path.string()});
    checkScene(scene);
    pairTriangles(scene);
  });
}

Scene twoTriangles() {
  Scene scene;
  scene.materials.resize(1);
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}})
    scene.vertices.push_back({{x, y, 0.0f}, 0, {0, 0}, ~0u, 0});
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  return scene;
}

}  // namespace

void fuzzGltf(std::string_view bytes) {
  loadAndCheck(writeFile(bytes.starts_with("glTF") ? "scene.glb" : "scene.gltf", bytes));
}

// One input is both files: the MTL follows a line "#mtl".
void fuzzObj(std::string_view bytes) {
  constexpr std::string_view border = "\n#mtl\n";
  const auto at = bytes.find(border);
  writeFile("scene.mtl", at == bytes.npos ? "" : bytes.substr(at + border.size()));
  loadAndCheck(writeFile("scene.obj", bytes.substr(0, at)));
}

void fuzzTexture(std::string_view bytes) {
  Texture texture;
  const std::span data(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  constexpr std::uint64_t most = 1'000'000;  // filling more pages would take the fuzzer's time
  if (countTexels(data) > most || !decodeTexture(data, texture)) return;
  if (texture.rgba.size() != std::size_t(texture.width) * std::size_t(texture.height) * 4)
    throw std::logic_error("a texture of another size than it says");
}

void fuzzQuadCache(std::string_view bytes) {
  static const Scene scene = twoTriangles();
  static const auto expected = pairTriangles(scene).quads;
  const auto folder = fuzzFolder() / "quads";
  cachedQuads(scene, folder);  // its name is a hash
  const auto file = std::filesystem::directory_iterator(folder)->path();
  std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  if (cachedQuads(scene, folder).quads != expected)
    throw std::logic_error("the cache of quads gave others than pairing does");
}

}  // namespace oitlab
