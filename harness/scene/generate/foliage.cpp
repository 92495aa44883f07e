#include "scene/generate/foliage.h"

#include <algorithm>
#include <array>

namespace oitlab {
namespace {

void addCard(MeshBuilder& builder, glm::vec3 center, glm::vec3 right, glm::vec3 up, bool pentagon,
             glm::vec3 normal, const Paint& paint) {
  // Two corners of the pentagon replace one corner of the square, where the texture is empty.
  constexpr std::array<glm::vec2, 5> pentagonCorners{
      {{-0.7f, -1.0f}, {0.7f, -1.0f}, {1.0f, 0.2f}, {0.0f, 1.0f}, {-1.0f, 0.2f}}};
  constexpr std::array<glm::vec2, 4> quadCorners{
      {{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}};
  const int corners = pentagon ? 5 : 4;
  const auto first = std::uint32_t(builder.vertexCount());
  for (int k = 0; k < corners; ++k) {
    const glm::vec2 c = pentagon ? pentagonCorners[std::size_t(k)] : quadCorners[std::size_t(k)];
    builder.vertex(center + c.x * right + c.y * up, normal, {0.5f + 0.5f * c.x, 0.5f - 0.5f * c.y},
                   paint.color, paint.material);
  }
  for (int k = 1; k + 1 < corners; ++k)
    builder.triangle(first, first + std::uint32_t(k), first + std::uint32_t(k + 1));
}

}  // namespace

glm::vec3 randomDirection(Pcg32& random) {
  const float y = random.uniform(-1.0f, 1.0f);
  const float angle = fullTurn * random.uniform();
  const float r = std::sqrt(std::max(1.0f - y * y, 0.0f));
  return {r * std::cos(angle), y, r * std::sin(angle)};
}

void addCards(MeshBuilder& builder, const CardCloud& cloud, const Paint& paint) {
  if (builder.counting()) {
    builder.count(4 * std::uint64_t(cloud.quads), 2 * std::uint64_t(cloud.quads));
    builder.count(5 * std::uint64_t(cloud.pentagons), 3 * std::uint64_t(cloud.pentagons));
    return;
  }
  Pcg32 random(cloud.seed);
  for (int i = 0; i < cloud.quads + cloud.pentagons; ++i) {
    const glm::vec3 out = randomDirection(random);
    const float inner = cloud.hollow * cloud.hollow * cloud.hollow;
    const glm::vec3 center =
        cloud.center + cloud.radii * out * std::cbrt(inner + (1.0f - inner) * random.uniform());
    const Frame frame = frameAround(randomDirection(random));
    const float size = cloud.halfSize * random.uniform(0.67f, 1.33f);
    // Normals are those of the crown's surface, not of each card: otherwise foliage looks like
    // gravel.
    const glm::vec3 facing = glm::cross(frame.right, frame.up);
    const glm::vec3 normal = glm::normalize(out + 0.4f * facing);
    const Paint tinted{paint.color * random.uniform(0.75f, 1.0f), paint.material};
    addCard(builder, center, size * frame.right, size * frame.up, i >= cloud.quads, normal, tinted);
  }
}

void addTrunk(MeshBuilder& builder, const TrunkShape& shape, const Paint& paint) {
  const int n = shape.segments;
  Pcg32 random(shape.seed);
  const auto wander = [&](glm::vec3 from, glm::vec3 to, float bend, float radius, float tip) {
    const glm::vec3 aside = bend * randomDirection(random);
    std::vector<glm::vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= n; ++i) {
      const float t = float(i) / float(n);
      path.push_back(glm::mix(from, to, t) + std::sin(0.5f * fullTurn * t) * aside);
      radii.push_back(radius + (tip - radius) * t);
    }
    tube(builder, path, shape.sides, radii, false, paint);
  };
  const glm::vec3 top = shape.foot + glm::vec3(0, shape.height, 0);
  wander(shape.foot, top, 0.05f * shape.height, shape.radius, 0.45f * shape.radius);
  for (int b = 0; b < shape.branches; ++b) {
    const glm::vec3 from = glm::mix(shape.foot, top, random.uniform(0.55f, 1.0f));
    glm::vec3 out = randomDirection(random);
    out.y = std::abs(out.y) * 0.8f;
    wander(from, top + shape.crown * out * random.uniform(0.6f, 0.95f), 0.12f * shape.crown.x,
           0.2f * shape.radius, 0.04f * shape.radius);
  }
}

}  // namespace oitlab
