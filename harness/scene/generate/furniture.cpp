#include "scene/generate/furniture.h"

#include "scene/generate/generators.h"

namespace oitlab {

void addChair(MeshBuilder& builder, const Placement& place, float fineness, const Paint& cushion,
              const Paint& frame) {
  const float s = std::sqrt(fineness);
  const auto cushionAt = [&](glm::vec3 center, glm::vec3 half, float lean) {
    ball(builder, scaledCount(12, s, 1), cushion, [&](glm::vec3 d) {
      // A superellipsoid: a shape between a box and an ellipsoid.
      const glm::vec3 p =
          d / std::pow(std::pow(std::abs(d.x), 4.0f) + std::pow(std::abs(d.y), 4.0f) +
                           std::pow(std::abs(d.z), 4.0f),
                       0.25f);
      const glm::vec3 at = center + half * p;
      return place({at.x, at.y, at.z - lean * (at.y - center.y)});
    });
  };
  cushionAt({0, 0.47f, 0}, {0.25f, 0.05f, 0.25f}, 0.0f);
  cushionAt({0, 0.8f, -0.25f}, {0.23f, 0.25f, 0.04f}, 0.2f);
  const int sides = scaledCount(8, s, 3), segments = scaledCount(4, s, 1);
  pipe(builder, place({0, 0.1f, 0}), place({0, 0.44f, 0}), 0.03f, sides, segments, true, frame);
  for (int leg = 0; leg < 5; ++leg) {
    const float a = fullTurn * float(leg) / 5.0f;
    const glm::vec3 foot(0.3f * std::cos(a), 0.06f, 0.3f * std::sin(a));
    pipe(builder, place({0, 0.12f, 0}), place(foot), 0.018f, sides, segments, true, frame);
    ball(builder, scaledCount(3, s, 1), frame,
         [&](glm::vec3 d) { return place(foot + glm::vec3(0, -0.025f, 0) + 0.035f * d); });
  }
  for (const float side : {0.27f, -0.27f}) {
    const int bend = scaledCount(16, s, 3);
    std::vector<glm::vec3> path;
    for (int i = 0; i <= bend; ++i) {
      const float a = 0.5f * fullTurn * float(i) / float(bend);
      path.push_back(place({side, 0.47f + 0.2f * std::sin(a), -0.2f * std::cos(a)}));
    }
    tube(builder, path, sides, std::vector<float>(path.size(), 0.02f), true, frame);
  }
}

void addColumn(MeshBuilder& builder, glm::vec3 foot, float height, float radius, float fineness,
               const Paint& paint) {
  const float s = std::sqrt(fineness);
  const Placement place{foot};
  box(builder, place, {0, 0.12f * radius, 0}, {1.5f * radius, 0.25f * radius, 1.5f * radius},
      paint);
  box(builder, place, {0, height - 0.2f * radius, 0}, {1.6f * radius, 0.2f * radius, 1.6f * radius},
      paint);
  const float low = 0.37f * radius, high = height - 0.4f * radius;
  const int sides = scaledCount(36, s, 5);
  sheet(builder, sides, scaledCount(40, s, 3), true, paint, [&](float u, float v) {
    const float flute = 1.0f - 0.05f * std::abs(std::sin(9.0f * u * fullTurn));
    const float base = 0.4f * std::exp(-v * 30.0f), cap = 0.45f * std::exp(-(1.0f - v) * 14.0f);
    const float r = radius * (flute - 0.12f * v + base + cap);
    return place({r * std::cos(u * fullTurn), low + (high - low) * v, -r * std::sin(u * fullTurn)});
  });
}

void addArch(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float thick, float fineness,
             const Paint& paint) {
  const int n = scaledCount(24, std::sqrt(fineness), 3);
  const float radius = 0.5f * glm::distance(from, to);
  std::vector<glm::vec3> path;
  for (int i = 0; i <= n; ++i) {
    const float a = 0.5f * fullTurn * float(i) / float(n);
    path.push_back(glm::mix(from, to, 0.5f - 0.5f * std::cos(a)) +
                   glm::vec3(0, radius * std::sin(a), 0));
  }
  tube(builder, path, 4, std::vector<float>(path.size(), 1.414f * thick), false, paint);
}

void addVase(MeshBuilder& builder, glm::vec3 foot, float height, float fineness,
             const Paint& paint) {
  const float s = std::sqrt(fineness);
  lathe(builder, {foot}, scaledCount(32, s, 4), scaledCount(30, s, 3), paint, [&](float v) {
    const float belly = 0.2f + 0.22f * std::sin(0.5f * fullTurn * std::pow(v, 0.8f) * 1.05f) +
                        0.08f * glm::smoothstep(0.85f, 1.0f, v);
    return glm::vec2(height * belly, height * v);
  });
}

void addBalustrade(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float height, int posts,
                   float fineness, const Paint& paint) {
  const float s = std::sqrt(fineness);
  const int sides = scaledCount(14, s, 3), rings = scaledCount(20, s, 2);
  const glm::vec3 along = to - from;
  const float gap = glm::length(along) / float(posts);
  for (int i = 0; i < posts; ++i)
    lathe(builder, {from + along * ((float(i) + 0.5f) / float(posts))}, sides, rings, paint,
          [&](float v) {
            return glm::vec2(0.25f * gap * (0.6f + 0.4f * std::sin(fullTurn * (1.5f * v + 0.6f))),
                             height * 0.92f * v);
          });
  const float turn = std::atan2(along.x, along.z);
  box(builder, {0.5f * (from + to), turn}, {0, height, 0},
      {0.3f * gap, 0.08f * height, 0.5f * glm::length(along)}, paint);
}

}  // namespace oitlab
