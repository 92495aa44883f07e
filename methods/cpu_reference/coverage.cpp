#include "coverage.h"

#include <algorithm>
#include <cmath>

#include "util/check.h"

namespace oitlab::cpu_reference {
namespace {

// With coordinates of up to 53 bits and pixels of up to 15 bits, an edge function is below 2^125.
constexpr int positionBits = 53;
constexpr int maxSide = 1 << 14;

// A centre exactly on an edge belongs to the triangle if the edge is its left or top edge: the rule
// of hardware rasterizers. `inside` is 1 or -1, the sign of the edge function inside the triangle.
// The rule is antisymmetric in the edge's direction, so of two triangles on both sides of a shared
// edge exactly one has the centre. An edge of length zero (a = b = 0) has none.
bool ownsItsPoints(Int128 a, Int128 b, int inside) {
  return a * inside > 0 || (a == 0 && b * inside > 0);
}

}  // namespace

Projection::Projection(const Scene& scene, const Camera& camera, int width, int height)
    : width_(width), height_(height) {
  OITLAB_CHECK_OP(std::max(width, height), <=, maxSide);
  OITLAB_CHECK_OP(std::min(width, height), >, 0);
  // The float32 matrix that all methods get defines the camera, so its rounding is not an error.
  // Sums of products of two floats lose at most the last bit of a double.
  const glm::dmat4 toClip(camera.projectionMatrix(float(width) / float(height)) *
                          camera.viewMatrix());
  const auto transform = [&](const Vertex& vertex) {
    const glm::dvec4 clip = toClip * glm::dvec4(vertex.position, 1.0);
    return glm::dvec3(clip.x * width, clip.y * height, clip.w);
  };
  double largest = 0.0;
  for (const Vertex& vertex : scene.vertices) {
    const glm::dvec3 p = glm::abs(transform(vertex));
    largest = std::max({largest, p.x, p.y, p.z});
  }
  int exponent = 0;  // largest < 2^exponent
  std::frexp(largest, &exponent);
  unit_ = std::ldexp(1.0, exponent - positionBits);
  positions_.reserve(scene.vertices.size());
  for (const Vertex& vertex : scene.vertices) {
    const glm::dvec3 p = transform(vertex) / unit_;
    positions_.push_back({std::llrint(p.x), std::llrint(p.y), std::llrint(p.z)});
  }
}

Triangle::Triangle(const Projection& projection, const glm::uvec3& corners)
    : projection_(projection),
      corners_{projection[corners.x], projection[corners.y], projection[corners.z]} {
  for (int i = 0; i < 3; ++i) {
    // The cross product of two corners is the plane through them and the eye.
    const Position &p = corners_[(i + 1) % 3], &q = corners_[(i + 2) % 3];
    Edge& edge = edges_[i];
    edge.a = Int128(p.y) * q.w - Int128(p.w) * q.y;
    edge.b = Int128(p.w) * q.x - Int128(p.x) * q.w;
    edge.c = Int128(p.x) * q.y - Int128(p.y) * q.x;
    // A pixel is two units of x.
    edge.reach = edgeDoubt * 2.0 * std::hypot(double(edge.a), double(edge.b));
  }
}

Hit Triangle::at(int pixelX, int pixelY) const {
  const int x = 2 * pixelX + 1 - projection_.width(), y = 2 * pixelY + 1 - projection_.height();
  Int128 value[3], sum = 0;
  for (int i = 0; i < 3; ++i) {
    value[i] = edges_[i].a * x + edges_[i].b * y + edges_[i].c;
    sum += value[i];
  }
  Hit hit;
  if (sum == 0) return hit;  // the triangle is seen edge-on
  const int inside = sum > 0 ? 1 : -1;
  bool nearEdge = false, withinReach = true;
  hit.covered = true;
  for (int i = 0; i < 3; ++i) {
    const Int128 inwards = value[i] * inside;
    if (inwards < 0 || (inwards == 0 && !ownsItsPoints(edges_[i].a, edges_[i].b, inside)))
      hit.covered = false;
    withinReach = withinReach && double(inwards) >= -edges_[i].reach;
    nearEdge = nearEdge || std::abs(double(inwards)) <= edges_[i].reach;
  }
  hit.nearEdge = nearEdge && withinReach;
  if (!hit.covered && !hit.nearEdge) return hit;

  const double scale = 1.0 / double(sum);
  double sumDx = 0.0, sumDy = 0.0;
  for (int i = 0; i < 3; ++i) {
    hit.weight[i] = double(value[i]) * scale;
    sumDx += 2.0 * double(edges_[i].a) * scale;
    sumDy += 2.0 * double(edges_[i].b) * scale;
  }
  for (int i = 0; i < 3; ++i) {  // the quotient rule
    hit.weightDx[i] = 2.0 * double(edges_[i].a) * scale - hit.weight[i] * sumDx;
    hit.weightDy[i] = 2.0 * double(edges_[i].b) * scale - hit.weight[i] * sumDy;
    hit.distance += hit.weight[i] * double(corners_[i].w) * projection_.unit();
  }
  // The line of sight also exists behind the eye, and a triangle there has weights too.
  if (hit.distance <= 0.0) hit.covered = hit.nearEdge = false;
  return hit;
}

PixelBox Triangle::box(double nearest) const {
  const double nearW = nearest / projection_.unit();
  glm::dvec2 low(1e300), high(-1e300);
  const auto include = [&](double x, double y, double w) {
    const glm::dvec2 pixel(0.5 * (x / w + projection_.width()),
                           0.5 * (y / w + projection_.height()));
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  };
  for (int i = 0; i < 3; ++i) {
    const Position &p = corners_[i], &q = corners_[(i + 1) % 3];
    const double pw = double(p.w), qw = double(q.w);
    if (pw >= nearW) include(double(p.x), double(p.y), pw);
    if ((pw >= nearW) != (qw >= nearW)) {
      const double t = (nearW - pw) / (qw - pw);
      include(double(p.x) + t * double(q.x - p.x), double(p.y) + t * double(q.y - p.y), nearW);
    }
  }
  // One more pixel on each side, because the box is rounded and edges near a pixel count too.
  const auto pixel = [](double v, int size) { return int(std::clamp(v, 0.0, double(size))); };
  PixelBox box{pixel(low.x - 1.0, projection_.width()), pixel(low.y - 1.0, projection_.height()),
               pixel(high.x + 2.0, projection_.width()), pixel(high.y + 2.0, projection_.height())};
  if (box.x0 >= box.x1 || box.y0 >= box.y1) return {};
  return box;
}

}  // namespace oitlab::cpu_reference
