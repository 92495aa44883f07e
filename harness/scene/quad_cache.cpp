// Pairing millions of triangles takes seconds, and every run of an experiment wants the same quads.
#include <cstring>
#include <span>
#include <string>

#include <xxhash.h>

#include "image/hash.h"
#include "scene/quads.h"
#include "util/error.h"
#include "util/paths.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

// Change it with the algorithm, the order of the quads or the layout of the file.
constexpr std::uint32_t kVersion = 1;

// The file: this, the quads, the ids of their triangles. Little-endian machines only ever meet
// their own cache; another byte order fails the magic.
struct Header {
  std::uint64_t magic = 0x64617571'6c74696full;  // "oitlquad"
  std::uint32_t version = kVersion;
  std::uint32_t degenerate = 0;
  std::uint64_t quads = 0;
  std::uint64_t sceneTriangles = 0;
  char key[32] = {};           // of the scene: the file may have been renamed
  std::uint64_t checksum = 0;  // XXH3 of the header, with this as 0, and of what follows it
};
static_assert(sizeof(Header) == 72);

constexpr std::size_t kBytesPerQuad = sizeof(glm::uvec4) + sizeof(glm::uvec2);

std::uint64_t checksumOf(std::string_view file) {
  Header header;
  std::memcpy(&header, file.data(), sizeof header);
  header.checksum = 0;
  const std::uint64_t ofHeader = XXH3_64bits(&header, sizeof header);
  return XXH3_64bits_withSeed(file.data() + sizeof header, file.size() - sizeof header, ofHeader);
}

std::string keyOf(const Scene& scene) {
  const std::string parts = imageHash(std::as_bytes(std::span(scene.triangles))) +
                            imageHash(std::as_bytes(std::span(scene.vertices)));
  return imageHash(std::as_bytes(std::span(parts)));
}

std::string toBytes(const QuadMesh& mesh, const Scene& scene, const std::string& key) {
  Header header{.degenerate = mesh.degenerate,
                .quads = mesh.quads.size(),
                .sceneTriangles = scene.triangles.size()};
  std::memcpy(header.key, key.data(), sizeof header.key);
  std::string file(sizeof header + mesh.quads.size() * kBytesPerQuad, '\0');
  char* const quads = file.data() + sizeof header;
  const std::size_t quadBytes = mesh.quads.size() * sizeof(glm::uvec4);
  if (!mesh.quads.empty()) {
    std::memcpy(quads, mesh.quads.data(), quadBytes);
    std::memcpy(quads + quadBytes, mesh.triangles.data(), mesh.quads.size() * sizeof(glm::uvec2));
  }
  std::memcpy(file.data(), &header, sizeof header);
  header.checksum = checksumOf(file);
  std::memcpy(file.data(), &header, sizeof header);
  return file;
}

/// False when the file is anything but what toBytes() wrote for this scene.
bool fromBytes(std::string_view file, const Scene& scene, const std::string& key, QuadMesh& mesh) {
  Header header;
  if (file.size() < sizeof header) return false;
  std::memcpy(&header, file.data(), sizeof header);
  if (header.magic != Header().magic || header.version != kVersion) return false;
  if (std::string_view(header.key, sizeof header.key) != key) return false;
  if (header.sceneTriangles != scene.triangles.size()) return false;
  // Compared by division: a damaged count times the size might wrap around to the right size.
  const std::size_t payload = file.size() - sizeof header;
  if (payload % kBytesPerQuad != 0 || header.quads != payload / kBytesPerQuad) return false;
  if (header.checksum != checksumOf(file)) return false;
  const auto quads = std::size_t(header.quads);
  mesh.quads.resize(quads);
  mesh.triangles.resize(quads);
  mesh.degenerate = header.degenerate;
  if (quads == 0) return true;
  const char* from = file.data() + sizeof header;
  std::memcpy(mesh.quads.data(), from, quads * sizeof(glm::uvec4));
  std::memcpy(mesh.triangles.data(), from + quads * sizeof(glm::uvec4), quads * sizeof(glm::uvec2));
  return true;
}

}  // namespace

QuadMesh cachedQuads(const Scene& scene, const std::filesystem::path& folder) {
  const std::string key = keyOf(scene);
  const std::filesystem::path path = folder / (key + ".bin");
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) {
    try {
      QuadMesh mesh;
      if (fromBytes(readTextFile(path), scene, key, mesh)) return mesh;
    } catch (const InputError&) {
      // Cannot be read: the same as damaged.
    }
  }
  QuadMesh mesh = pairTriangles(scene);
  std::filesystem::create_directories(folder, ignored);
  try {
    writeFileAtomically(path, toBytes(mesh, scene, key));
  } catch (const InputError&) {
    // A full or read-only disk: the cache is a convenience, and the quads are right without it.
  }
  return mesh;
}

QuadMesh cachedQuads(const Scene& scene) {
  return cachedQuads(scene, cacheRoot() / "quads");
}

}  // namespace oitlab
