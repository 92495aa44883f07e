#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "scene/import/gltf_parts.h"
#include "util/error.h"

namespace oitlab {
namespace {

constexpr std::uint32_t notYet = 0xffffffffu;

// The square of a larger length overflows a float, and bounds and normals need such squares.
constexpr float largest = 1e18f;

bool usable(const glm::vec3& v) {  // false for NaN too
  return std::abs(v.x) < largest && std::abs(v.y) < largest && std::abs(v.z) < largest;
}

std::vector<glm::uvec3> assemble(const std::vector<std::uint32_t>& indices, int mode) {
  std::vector<glm::uvec3> triangles;
  const std::size_t n = indices.size();
  if (n < 3) return triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3)
      triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {  // glTF 2.0, 3.7.2.1: odd triangles have the
                                                      // other winding
    for (std::size_t i = 0; i + 2 < n; ++i)
      triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
  } else {
    for (std::size_t i = 0; i + 2 < n; ++i)
      triangles.emplace_back(indices[i + 1], indices[i + 2], indices[0]);
  }
  return triangles;
}

glm::vec3 faceNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 normal =
      glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  const double length = glm::length(normal);
  return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0, 1, 0);
}

// Normals are transformed by the inverse transpose. The cofactor matrix is the inverse transpose
// times the determinant, and also exists for singular matrices. The sign of the determinant is
// corrected for reflections.
glm::dmat3 normalMatrix(const glm::dmat4& world) {
  const glm::dmat3 m(world);
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0 ? -cofactors : cofactors;
}

// The primitive's vertex attributes. Each is checked to have one element per vertex.
struct Attributes {
  GltfAccessor position;
  std::optional<GltfAccessor> normal, uv, color;
};

Attributes readAttributes(const GltfFile& file, const tinygltf::Primitive& primitive, int texCoord,
                          const std::string& place) {
  const auto find = [&](const std::string& name, int least,
                        int most) -> std::optional<GltfAccessor> {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return {};
    GltfAccessor accessor(file, found->second, fmt::format("{}, {}", place, name));
    if (accessor.components() < least || accessor.components() > most)
      fail<InputError>("{}, {}: {} components, expected {}", place, name, accessor.components(),
                       least == most ? std::to_string(least) : "3 or 4");
    return accessor;
  };
  Attributes attributes{*find("POSITION", 3, 3), find("NORMAL", 3, 3),
                        find(fmt::format("TEXCOORD_{}", texCoord), 2, 2), find("COLOR_0", 3, 4)};
  for (const auto& [accessor, name] : {std::pair{&attributes.normal, "NORMAL"},
                                       {&attributes.uv, "TEXCOORD"},
                                       {&attributes.color, "COLOR_0"}})
    if (*accessor && (*accessor)->count() != attributes.position.count())
      fail<InputError>("{}, {}: {} elements, but POSITION has {}", place, name,
                       (*accessor)->count(), attributes.position.count());
  return attributes;
}

}  // namespace

void readGltfPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive,
                       const glm::dmat4& world, const GltfMaterial& material,
                       const std::string& place, Scene& scene) {
  const int mode = primitive.mode == -1 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN)
    return scene.repaired("primitives of points or lines skipped");
  if (!primitive.attributes.contains("POSITION"))
    return scene.repaired("primitives without positions skipped");
  const Attributes from = readAttributes(file, primitive, material.texCoord, place);
  const std::size_t count = from.position.count();

  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = GltfAccessor(file, primitive.indices, place + ", indices").indices(count);
  } else {
    indices.resize(count);
    std::iota(indices.begin(), indices.end(), 0u);
  }
  if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
    scene.repaired("incomplete last triangles dropped");
  std::vector<glm::uvec3> triangles = assemble(indices, mode);
  if (scene.vertices.size() + 3 * triangles.size() >= notYet)
    fail<InputError>("{}: more vertices than 32 bits can number", place);
  // With normals at most those there are; without, three for each triangle.
  const std::size_t most = 3 * triangles.size();
  file.budget.addVertices(from.normal ? std::min(most, count) : most, triangles.size(),
                          "this primitive");

  std::vector<glm::vec3> positions(count);
  for (std::size_t i = 0; i < count; ++i)
    positions[i] = glm::vec3(world * glm::dvec4(from.position.vec3(i), 1.0));
  const glm::dmat3 normals = normalMatrix(world);
  const bool mirrored = glm::determinant(glm::dmat3(world)) < 0.0;

  std::uint64_t dropped = 0, badNormals = 0, badUvs = 0;
  const auto emit = [&](std::uint32_t i, const glm::vec3& flat) {
    Vertex vertex{.position = positions[i], .material = material.index};
    glm::vec3 normal = flat;
    if (from.normal) {
      const glm::dvec3 moved = normals * glm::dvec3(from.normal->vec3(i));
      const double length = glm::length(moved);
      if (length > 0.0 && std::isfinite(length))
        normal = glm::vec3(moved / length);
      else
        ++badNormals;
    }
    vertex.normal = packNormal(normal);
    if (from.uv) {
      vertex.uv = material.uvTransform * glm::vec3(from.uv->vec2(i), 1.0f);
      if (!std::isfinite(vertex.uv.x) || !std::isfinite(vertex.uv.y)) {
        vertex.uv = glm::vec2(0.0f);
        ++badUvs;
      }
    }
    glm::vec4 color(1.0f);
    if (from.color)
      for (int c = 0; c < from.color->components(); ++c) color[c] = from.color->number(i, c, true);
    vertex.color = packColor(color);
    scene.vertices.push_back(vertex);
    return std::uint32_t(scene.vertices.size() - 1);
  };

  // Only the vertices that this primitive uses, because many primitives may share one large list.
  // For a primitive without normals glTF demands flat ones, and then no vertex can be shared.
  std::vector<std::uint32_t> emitted(from.normal ? count : 0, notYet);
  scene.triangles.reserve(scene.triangles.size() + triangles.size());
  for (glm::uvec3 triangle : triangles) {
    if (mirrored) std::swap(triangle.y, triangle.z);
    const std::array corners{positions[triangle.x], positions[triangle.y], positions[triangle.z]};
    if (!usable(corners[0]) || !usable(corners[1]) || !usable(corners[2])) {
      ++dropped;
      continue;
    }
    const auto flat = [&] { return faceNormal(corners[0], corners[1], corners[2]); };
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t i = triangle[c];
      if (!from.normal)
        triangle[c] = emit(i, flat());
      else
        triangle[c] = emitted[i] == notYet ? (emitted[i] = emit(i, flat())) : emitted[i];
    }
    scene.triangles.push_back(triangle);
  }
  scene.repaired("triangles with non-finite positions dropped", dropped);
  scene.repaired("zero or non-finite normals replaced by the triangle's", badNormals);
  scene.repaired("non-finite texture coordinates set to 0", badUvs);
}

}  // namespace oitlab
