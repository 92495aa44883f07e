#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "scene/generate/mesh_builder.h"

namespace oitlab {

// The shapes that generated scenes consist of. With a counting builder each adds its numbers at
// once. Colours are linear.

constexpr float fullTurn = 2.0f * std::numbers::pi_v<float>;  ///< a full turn, radians

/// The material and colour of a shape.
struct Paint {
  glm::vec3 color{0.8f};
  std::uint32_t material = 0;
};

/// Where a shape stands: it is rotated about +Y, then moved.
struct Placement {
  glm::vec3 origin{0.0f};
  float turn = 0.0f;  ///< radians
  glm::vec3 operator()(glm::vec3 p) const {
    const float c = std::cos(turn), s = std::sin(turn);
    return origin + glm::vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
  }
};

/// Two unit vectors that are perpendicular to each other and to `direction`, whose length may be
/// any. cross(first, second) points along it.
struct Frame {
  glm::vec3 right, up;
};
Frame frameAround(glm::vec3 direction);

/// The smooth sheet position(u, v) for u and v in [0, 1], in nu x nv cells of two triangles. It
/// faces cross(along u, along v). With `wrap` the last column of u is the first one again. Keep v
/// away from poles: vertices that coincide there give triangles without area.
template <typename Position>
void sheet(MeshBuilder& builder, int nu, int nv, bool wrap, const Paint& paint,
           Position&& position) {
  const int columns = wrap ? nu : nu + 1;
  if (builder.counting())
    return builder.count(std::uint64_t(columns) * std::uint64_t(nv + 1),
                         2 * std::uint64_t(nu) * std::uint64_t(nv));
  std::vector<glm::vec3> points(std::size_t(columns) * std::size_t(nv + 1));
  for (int j = 0, k = 0; j <= nv; ++j)
    for (int i = 0; i < columns; ++i)
      points[std::size_t(k++)] = position(float(i) / float(nu), float(j) / float(nv));
  const auto at = [&](int i, int j) {
    if (wrap) i = (i + nu) % nu;
    return points[std::size_t(j * columns + i)];
  };
  const auto first = std::uint32_t(builder.vertexCount());
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i < columns; ++i) {
      const glm::vec3 alongU = at(wrap || i < nu ? i + 1 : i, j) - at(wrap || i > 0 ? i - 1 : i, j);
      const glm::vec3 alongV = at(i, std::min(j + 1, nv)) - at(i, std::max(j - 1, 0));
      const glm::vec3 normal = glm::cross(alongU, alongV);
      const float length = glm::length(normal);
      builder.vertex(at(i, j), length > 0.0f ? normal / length : glm::vec3(0, 1, 0),
                     {float(i) / float(nu), float(j) / float(nv)}, paint.color, paint.material);
    }
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const std::uint32_t row = first + std::uint32_t(j * columns);
      const std::uint32_t a = row + std::uint32_t(i);
      const std::uint32_t b = row + std::uint32_t(wrap ? (i + 1) % nu : i + 1);
      const auto up = std::uint32_t(columns);
      builder.triangle(a, b, b + up);
      builder.triangle(a, b + up, a + up);
    }
}

/// A fan over the ring of vertices rim(k) for k from 0 to `sides` - 1, counter-clockwise about
/// `normal`.
template <typename Rim>
void fan(MeshBuilder& builder, int sides, glm::vec3 normal, const Paint& paint, Rim&& rim) {
  if (builder.counting()) return builder.count(std::uint64_t(sides), std::uint64_t(sides - 2));
  const auto first = std::uint32_t(builder.vertexCount());
  for (int k = 0; k < sides; ++k)
    builder.vertex(rim(k), normal, {0.5f, 0.5f}, paint.color, paint.material);
  for (int k = 1; k + 1 < sides; ++k)
    builder.triangle(first, first + std::uint32_t(k), first + std::uint32_t(k + 1));
}

/// A tube of `sides` >= 3 strips along `path`, which has at least two points and no equal
/// neighbours. radius(t) is its radius for t from 0 to 1 along the path. With `closed` its ends are
/// closed.
void tube(MeshBuilder& builder, const std::vector<glm::vec3>& path, int sides,
          const std::vector<float>& radii, bool closed, const Paint& paint);

/// A straight tube between two points.
void pipe(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float radius, int sides, int segments,
          bool closed, const Paint& paint);

/// A surface of revolution about +Y through `place`. profile(v) is (radius, height); if it goes
/// upwards, the surface faces outwards.
template <typename Profile>
void lathe(MeshBuilder& builder, const Placement& place, int sides, int rings, const Paint& paint,
           Profile&& profile) {
  sheet(builder, sides, rings, true, paint, [&](float u, float v) {
    const glm::vec2 p = profile(v);
    return place({p.x * std::cos(u * fullTurn), p.y, -p.x * std::sin(u * fullTurn)});
  });
}

/// A closed ball of 12 * n * n triangles: a subdivided cube whose vertices are at
/// position(direction).
template <typename Position>
void ball(MeshBuilder& builder, int n, const Paint& paint, Position&& position) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.0f, -1.0f})
      sheet(builder, n, n, false, paint, [&](float u, float v) {
        // The tangent makes the cells about equally large. The argument is computed from integers,
        // so that both neighbours get the same edge.
        const auto bend = [n](float x) {
          const int step = 2 * int(std::lround(x * float(n))) - n;
          if (step == n || step == -n) return step > 0 ? 1.0f : -1.0f;
          return std::tan(float(step) / float(n) * 0.125f * fullTurn);
        };
        const float a = bend(u), b = bend(v);
        glm::vec3 p(0.0f);
        p[axis] = side;
        p[(axis + 1) % 3] = side * a;
        p[(axis + 2) % 3] = b;
        return position(glm::normalize(p));
      });
}

/// A box of half size `half`, parallel to the axes before it is placed, of 12 n^2 triangles.
void box(MeshBuilder& builder, const Placement& place, glm::vec3 center, glm::vec3 half,
         const Paint& paint, int n = 1);

/// A flat rectangle from `corner` along `u` and `v`, in nu x nv cells. It faces cross(u, v).
void panel(MeshBuilder& builder, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int nu, int nv,
           const Paint& paint);

}  // namespace oitlab
