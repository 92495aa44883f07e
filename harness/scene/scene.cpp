#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace oitlab {
namespace {

// A number in [-1, 1] as a 16-bit snorm, rounded to nearest.
std::uint32_t snorm16(float x) {
  const float scaled = std::clamp(x, -1.0f, 1.0f) * 32767.0f;
  return std::uint32_t(std::int32_t(std::lround(scaled))) & 0xffffu;
}

float fromSnorm16(std::uint32_t bits) {
  return std::max(float(std::int16_t(bits & 0xffffu)) / 32767.0f, -1.0f);
}

// Zero counts as positive, because a sign of 0 would collapse the folds of the map.
glm::vec2 signs(glm::vec2 v) {
  return {v.x < 0.0f ? -1.0f : 1.0f, v.y < 0.0f ? -1.0f : 1.0f};
}

}  // namespace

bool Texture::hasAlpha() const {
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    if (rgba[i] != 255) return true;
  return false;
}

void Scene::repaired(const std::string& what, std::uint64_t count) {
  if (count == 0) return;
  const auto known = std::ranges::find(repairs, what, &Repair::what);
  if (known != repairs.end())
    known->count += count;
  else
    repairs.push_back({what, count});
}

// Octahedral map: Cigolle et al., "A Survey of Efficient Representations for Independent Unit
// Vectors", JCGT 3(2), 2014. At 2x16 bits its error is below 0.01 degrees.
std::uint32_t packNormal(glm::vec3 n) {
  const float length1 = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  glm::vec2 p = glm::vec2(n) / length1;
  if (n.z < 0.0f) p = (1.0f - glm::abs(glm::vec2(p.y, p.x))) * signs(p);
  return snorm16(p.x) | (snorm16(p.y) << 16);
}

glm::vec3 unpackNormal(std::uint32_t packed) {
  const glm::vec2 p(fromSnorm16(packed), fromSnorm16(packed >> 16));
  glm::vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
  if (n.z < 0.0f) {
    const glm::vec2 folded = (1.0f - glm::abs(glm::vec2(n.y, n.x))) * signs(n);
    n.x = folded.x;
    n.y = folded.y;
  }
  return glm::normalize(n);
}

std::uint32_t packColor(glm::vec4 linear) {
  std::uint32_t packed = 0;
  for (int i = 0; i < 4; ++i) {
    const float c = linear[i] > 0.0f ? std::min(linear[i], 1.0f) : 0.0f;  // NaN becomes 0
    packed |= std::uint32_t(c * 255.0f + 0.5f) << (8 * i);
  }
  return packed;
}

void computeBounds(Scene& scene) {
  if (scene.triangles.empty()) {
    scene.bounds = {};
    return;
  }
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(std::numeric_limits<float>::lowest());
  for (const glm::uvec3& triangle : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3& position = scene.vertices[triangle[corner]].position;
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
  scene.bounds = {low, high};
}

void overrideOpacity(Scene& scene, float opacity) {
  for (Material& material : scene.materials) {
    // The cutoff is scaled by the same factor as alpha, so that it cuts the same texels as before.
    // A material that was invisible (alpha 0 under a cutoff) stays invisible: no alpha reaches 2.
    if (material.alphaCutoff > 0.0f)
      material.alphaCutoff = material.baseColor.a > 0.0f
                                 ? material.alphaCutoff * opacity / material.baseColor.a
                                 : 2.0f;
    material.baseColor.a = opacity;
    material.alphaMode = AlphaMode::blend;
    material.ignoreVertexAlpha = true;
  }
}

}  // namespace oitlab
