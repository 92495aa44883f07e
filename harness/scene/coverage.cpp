#include "scene/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace oitlab {
namespace {

// A triangle that is clipped at the near plane has at most four corners.
struct Polygon {
  std::array<glm::dvec2, 4> corners;  // pixels
  int count = 0;
};

class Rasterizer {
 public:
  Rasterizer(const Camera& camera, int width, int height)
      : matrix_(camera.projectionMatrix(float(width) / float(height)) * camera.viewMatrix()),
        near_(camera.near),
        width_(width),
        height_(height),
        // One extra column, for spans that end at the right edge.
        steps_(std::size_t(width + 1) * std::size_t(height)) {}

  glm::dvec4 toClip(glm::vec3 p) const { return matrix_ * glm::dvec4(p, 1.0); }

  bool outside(const std::array<glm::dvec4, 3>& p) const {
    const auto all = [&](auto&& beyond) { return beyond(p[0]) && beyond(p[1]) && beyond(p[2]); };
    return all([](const glm::dvec4& v) { return v.x < -v.w; }) ||
           all([](const glm::dvec4& v) { return v.x > v.w; }) ||
           all([](const glm::dvec4& v) { return v.y < -v.w; }) ||
           all([](const glm::dvec4& v) { return v.y > v.w; }) ||
           all([&](const glm::dvec4& v) { return v.w < near_; });
  }

  Polygon project(const std::array<glm::dvec4, 3>& p) const {
    Polygon polygon;
    const auto add = [&](const glm::dvec4& v) {
      polygon.corners[std::size_t(polygon.count++)] = {(v.x / v.w * 0.5 + 0.5) * width_,
                                                       (v.y / v.w * 0.5 + 0.5) * height_};
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec4 &a = p[i], &b = p[(i + 1) % 3];
      if (a.w >= near_) add(a);
      if ((a.w >= near_) != (b.w >= near_)) add(a + (b - a) * ((near_ - a.w) / (b.w - a.w)));
    }
    return polygon;
  }

  // Whether its bounding box holds a pixel centre.
  bool holdsCentre(const Polygon& polygon) const {
    glm::dvec2 low(1e30), high(-1e30);
    for (int i = 0; i < polygon.count; ++i) {
      low = glm::min(low, polygon.corners[std::size_t(i)]);
      high = glm::max(high, polygon.corners[std::size_t(i)]);
    }
    low = glm::max(low, glm::dvec2(0.0));
    high = glm::min(high, glm::dvec2(width_, height_));
    return polygon.count > 0 && firstCentre(low.x) < firstCentre(high.x) &&
           firstCentre(low.y) < firstCentre(high.y);
  }

  // A span is stored as a step up and a step down, so that the cost of a large triangle grows with
  // its height, not with its area.
  void fill(const Polygon& polygon) {
    double low = 1e30, high = -1e30;
    for (int i = 0; i < polygon.count; ++i) {
      low = std::min(low, polygon.corners[std::size_t(i)].y);
      high = std::max(high, polygon.corners[std::size_t(i)].y);
    }
    const int first = int(firstCentre(std::max(low, 0.0)));
    const int end = int(firstCentre(std::min(high, double(height_))));
    for (int y = first; y < end; ++y) {
      double left = 1e30, right = -1e30;
      for (int i = 0; i < polygon.count; ++i) {
        const glm::dvec2 a = polygon.corners[std::size_t(i)];
        const glm::dvec2 b = polygon.corners[std::size_t((i + 1) % polygon.count)];
        const double centre = y + 0.5;
        if ((a.y <= centre) == (b.y <= centre)) continue;
        const double x = a.x + (b.x - a.x) * ((centre - a.y) / (b.y - a.y));
        left = std::min(left, x);
        right = std::max(right, x);
      }
      const double from = firstCentre(std::clamp(left, 0.0, double(width_)));
      const double to = firstCentre(std::clamp(right, 0.0, double(width_)));
      if (!(from < to)) continue;
      int* row = steps_.data() + std::size_t(y) * std::size_t(width_ + 1);
      ++row[int(from)];
      --row[int(to)];
    }
  }

  void sum(Coverage& coverage) const {
    for (int y = 0; y < height_; ++y) {
      int depth = 0;
      const int* row = steps_.data() + std::size_t(y) * std::size_t(width_ + 1);
      for (int x = 0; x < width_; ++x) {
        depth += row[x];
        coverage.samples += std::uint64_t(depth);
        coverage.coveredPixels += depth > 0;
        coverage.peakDepth = std::max(coverage.peakDepth, std::uint32_t(depth));
      }
    }
  }

 private:
  // The first pixel whose centre is at x or to the right of it.
  static double firstCentre(double x) { return std::ceil(x - 0.5); }

  glm::dmat4 matrix_;
  double near_;
  int width_, height_;
  std::vector<int> steps_;
};

}  // namespace

Coverage measureCoverage(const Scene& scene, const Camera& camera, int width, int height) {
  Rasterizer rasterizer(camera, width, height);
  Coverage coverage;
  for (const glm::uvec3& triangle : scene.triangles) {
    const glm::vec3 a = scene.vertices[triangle.x].position;
    const glm::vec3 b = scene.vertices[triangle.y].position;
    const glm::vec3 c = scene.vertices[triangle.z].position;
    const std::array clip{rasterizer.toClip(a), rasterizer.toClip(b), rasterizer.toClip(c)};
    if (rasterizer.outside(clip)) continue;
    const Polygon polygon = rasterizer.project(clip);
    if (!rasterizer.holdsCentre(polygon)) continue;
    ++coverage.visible;
    coverage.visibleFront += glm::dot(glm::cross(b - a, c - a), camera.eye - a) > 0.0f;
    rasterizer.fill(polygon);
  }
  rasterizer.sum(coverage);
  return coverage;
}

}  // namespace oitlab
