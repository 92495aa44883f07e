#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "scene/generate/mesh_builder.h"

namespace oitlab {

// The shapes that generated scenes are put together from. Each counts itself at once under a
// counting builder. Colours are linear.

constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;  ///< a full turn, radians

/// What a shape is made of.
struct Paint {
  glm::vec3 color{0.8f};
  std::uint32_t material = 0;
};

/// A position moved to where a shape stands: turned about +Y, then shifted.
struct Placement {
  glm::vec3 origin{0.0f};
  float turn = 0.0f;  ///< radians
  glm::vec3 operator()(glm::vec3 p) const {
    const float c = std::cos(turn), s = std::sin(turn);
    return origin + glm::vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
  }
};

/// Unit vectors at right angles to `direction` (which need not be of unit length) and each other:
/// cross(first, second) points along it.
struct Frame {
  glm::vec3 right, up;
};
Frame frameAround(glm::vec3 direction);

/// The sheet position(u, v), u and v in [0, 1], in nu x nv cells of two triangles each, facing
/// cross(along u, along v), smooth. With `wrap` the last column of u is the first again. Vertices
/// that fall together at a pole give triangles without area: keep v away from poles.
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

/// A fan over a ring of `sides` vertices that `rim(k)` gives, counter-clockwise about `normal`.
template <typename Rim>
void fan(MeshBuilder& builder, int sides, glm::vec3 normal, const Paint& paint, Rim&& rim) {
  if (builder.counting()) return builder.count(std::uint64_t(sides), std::uint64_t(sides - 2));
  const auto first = std::uint32_t(builder.vertexCount());
  for (int k = 0; k < sides; ++k)
    builder.vertex(rim(k), normal, {0.5f, 0.5f}, paint.color, paint.material);
  for (int k = 1; k + 1 < sides; ++k)
    builder.triangle(first, first + std::uint32_t(k), first + std::uint32_t(k + 1));
}

/// A tube along `path` (at least two points, no two neighbours the same) with radius(t) for t from
/// 0 to 1 along it, in `sides` >= 3 strips; its ends are closed when `closed`.
void tube(MeshBuilder& builder, const std::vector<glm::vec3>& path, int sides,
          const std::vector<float>& radii, bool closed, const Paint& paint);

/// A straight tube between two points.
void pipe(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float radius, int sides, int segments,
          bool closed, const Paint& paint);

/// A solid of revolution about +Y through `place`: profile(v) is (radius, height), upwards for a
/// surface that faces outwards.
template <typename Profile>
void lathe(MeshBuilder& builder, const Placement& place, int sides, int rings, const Paint& paint,
           Profile&& profile) {
  sheet(builder, sides, rings, true, paint, [&](float u, float v) {
    const glm::vec2 p = profile(v);
    return place({p.x * std::cos(u * kTurn), p.y, -p.x * std::sin(u * kTurn)});
  });
}

/// A closed ball of 12 * n * n triangles: the cube's sides blown up, moved to position(direction).
template <typename Position>
void ball(MeshBuilder& builder, int n, const Paint& paint, Position&& position) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.0f, -1.0f})
      sheet(builder, n, n, false, paint, [&](float u, float v) {
        // Tangents even out the cells. Whole steps, since neighbours must get the same edge from
        // either end.
        const auto bend = [n](float x) {
          const int step = 2 * int(std::lround(x * float(n))) - n;
          if (step == n || step == -n) return step > 0 ? 1.0f : -1.0f;
          return std::tan(float(step) / float(n) * 0.125f * kTurn);
        };
        const float a = bend(u), b = bend(v);
        glm::vec3 p(0.0f);
        p[axis] = side;
        p[(axis + 1) % 3] = side * a;
        p[(axis + 2) % 3] = b;
        return position(glm::normalize(p));
      });
}

/// An axis-parallel box of half size `half` before it is placed: 12 triangles, or 12 n^2.
void box(MeshBuilder& builder, const Placement& place, glm::vec3 center, glm::vec3 half,
         const Paint& paint, int n = 1);

/// A flat rectangle from `corner` along `u` and `v`, in nu x nv cells; faces cross(u, v).
void panel(MeshBuilder& builder, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int nu, int nv,
           const Paint& paint);

}  // namespace oitlab
