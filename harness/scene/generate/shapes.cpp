#include "scene/generate/shapes.h"

#include <algorithm>

namespace oitlab {

Frame frameAround(glm::vec3 direction) {
  const glm::vec3 along = glm::normalize(direction);
  const glm::vec3 aside = std::abs(along.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 right = glm::normalize(glm::cross(aside, along));
  return {right, glm::cross(along, right)};
}

void tube(MeshBuilder& builder, const std::vector<glm::vec3>& path, int sides,
          const std::vector<float>& radii, bool closed, const Paint& paint) {
  const int n = int(path.size());
  const auto rings = std::uint64_t(n), around = std::uint64_t(sides);
  if (builder.counting()) {
    builder.count(rings * around, 2 * (rings - 1) * around);
    if (closed) builder.count(2 * around, 2 * (around - 2));
    return;
  }
  const auto first = std::uint32_t(builder.vertexCount());
  Frame frame = frameAround(path[1] - path[0]), start = frame;
  for (int j = 0; j < n; ++j) {
    const glm::vec3 along =
        path[std::size_t(std::min(j + 1, n - 1))] - path[std::size_t(std::max(j - 1, 0))];
    // The frame is rotated as little as possible from ring to ring, so that the tube does not
    // twist.
    const glm::vec3 right =
        frame.right - along * glm::dot(frame.right, along) / glm::dot(along, along);
    if (glm::length(right) > 1e-3f) {
      frame.right = glm::normalize(right);
      frame.up = glm::normalize(glm::cross(along, frame.right));
    } else {
      frame = frameAround(along);
    }
    for (int k = 0; k < sides; ++k) {
      const float angle = fullTurn * float(k) / float(sides);
      const glm::vec3 out = std::cos(angle) * frame.right + std::sin(angle) * frame.up;
      builder.vertex(path[std::size_t(j)] + radii[std::size_t(j)] * out, out,
                     {float(k) / float(sides), float(j) / float(n - 1)}, paint.color,
                     paint.material);
    }
    if (j == 0) start = frame;
  }
  const auto s = std::uint32_t(sides);
  for (std::uint32_t j = 0; j + 1 < std::uint32_t(n); ++j)
    for (std::uint32_t k = 0; k < s; ++k) {
      const std::uint32_t a = first + j * s + k, b = first + j * s + (k + 1) % s;
      builder.triangle(a, b, b + s);
      builder.triangle(a, b + s, a + s);
    }
  if (!closed) return;
  const auto cap = [&](glm::vec3 centre, glm::vec3 out, float radius, const Frame& f, float sense) {
    fan(builder, sides, glm::normalize(out), paint, [&](int k) {
      const float angle = sense * fullTurn * float(k) / float(sides);
      return centre + radius * (std::cos(angle) * f.right + std::sin(angle) * f.up);
    });
  };
  cap(path.front(), path[0] - path[1], radii.front(), start, -1.0f);
  cap(path.back(), path.back() - path[path.size() - 2], radii.back(), frame, 1.0f);
}

void pipe(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float radius, int sides, int segments,
          bool closed, const Paint& paint) {
  std::vector<glm::vec3> path(std::size_t(segments) + 1);
  if (!builder.counting())
    for (int i = 0; i <= segments; ++i)
      path[std::size_t(i)] = glm::mix(from, to, float(i) / float(segments));
  tube(builder, path, sides, std::vector<float>(path.size(), radius), closed, paint);
}

void box(MeshBuilder& builder, const Placement& place, glm::vec3 center, glm::vec3 half,
         const Paint& paint, int n) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.0f, -1.0f})
      sheet(builder, n, n, false, paint, [&](float u, float v) {
        glm::vec3 p(0.0f);
        p[axis] = side;
        p[(axis + 1) % 3] = side * (2.0f * u - 1.0f);
        p[(axis + 2) % 3] = 2.0f * v - 1.0f;
        return place(center + half * p);
      });
}

void panel(MeshBuilder& builder, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int nu, int nv,
           const Paint& paint) {
  sheet(builder, nu, nv, false, paint, [&](float s, float t) { return corner + s * u + t * v; });
}

}  // namespace oitlab
