// Pairing millions of triangles takes seconds, and every run of an experiment needs the same quads.
#include <cstring>
#include <span>
#include <string>

#include <fmt/format.h>

#include "image/hash.h"
#include "scene/quads.h"
#include "util/cache_file.h"
#include "util/paths.h"

namespace oitlab {
namespace {

// Change it with the algorithm, the order of the quads or the layout of the content.
constexpr int version = 2;

// The content of the file: the number of degenerate quads, the quads, the ids of their triangles.
constexpr std::size_t headBytes = sizeof(std::uint32_t);
constexpr std::size_t bytesPerQuad = sizeof(glm::uvec4) + sizeof(glm::uvec2);

std::string hashOf(const Scene& scene) {
  const std::string parts = imageHash(std::as_bytes(std::span(scene.triangles))) +
                            imageHash(std::as_bytes(std::span(scene.vertices)));
  return imageHash(std::as_bytes(std::span(parts)));
}

std::string toBytes(const QuadMesh& mesh) {
  const std::size_t quadBytes = mesh.quads.size() * sizeof(glm::uvec4);
  std::string bytes(headBytes + mesh.quads.size() * bytesPerQuad, '\0');
  std::memcpy(bytes.data(), &mesh.degenerate, headBytes);
  if (mesh.quads.empty()) return bytes;
  char* const quads = bytes.data() + headBytes;
  std::memcpy(quads, mesh.quads.data(), quadBytes);
  std::memcpy(quads + quadBytes, mesh.triangles.data(), mesh.quads.size() * sizeof(glm::uvec2));
  return bytes;
}

/// Empty when the size is not that of a mesh.
std::optional<QuadMesh> fromBytes(std::string_view bytes) {
  if (bytes.size() < headBytes || (bytes.size() - headBytes) % bytesPerQuad != 0)
    return std::nullopt;
  const std::size_t quads = (bytes.size() - headBytes) / bytesPerQuad;
  QuadMesh mesh;
  mesh.quads.resize(quads);
  mesh.triangles.resize(quads);
  std::memcpy(&mesh.degenerate, bytes.data(), headBytes);
  if (quads == 0) return mesh;
  const char* from = bytes.data() + headBytes;
  std::memcpy(mesh.quads.data(), from, quads * sizeof(glm::uvec4));
  std::memcpy(mesh.triangles.data(), from + quads * sizeof(glm::uvec4), quads * sizeof(glm::uvec2));
  return mesh;
}

}  // namespace

QuadMesh cachedQuads(const Scene& scene, const std::filesystem::path& folder) {
  const std::string hash = hashOf(scene);
  const std::string key = fmt::format("quads {} {}", version, hash);
  const std::filesystem::path path = folder / (hash + ".bin");
  if (const auto bytes = readCached(path, key))
    if (auto mesh = fromBytes(*bytes)) return *std::move(mesh);
  QuadMesh mesh = pairTriangles(scene);
  writeCached(path, key, toBytes(mesh));
  return mesh;
}

QuadMesh cachedQuads(const Scene& scene) {
  return cachedQuads(scene, cacheRoot() / "quads");
}

}  // namespace oitlab
