#include "cpu_renderer.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "coverage.h"
#include "render/renderer.h"
#include "shading.h"
#include "util/parallel.h"

namespace oitlab {
namespace cpu_reference {
namespace {

// Relative error of a float32 depth: about 60 roundings of 2^-24, from a transform with
// cancellation near the eye, the division and the interpolation. Where depth is steep, snapped
// vertices change it more; that is added (Fragment::depthDoubt).
constexpr double depthPrecision = 4e-6;

// The largest difference that is ignored: half of the tolerance of 2/255 for methods.
constexpr double visible = 1.0 / 255;

struct Fragment {
  int x = 0;
  std::uint32_t id = 0;     // primitive id
  double depth = 0.0;       // near / distance: larger is nearer
  double depthDoubt = 0.0;  // possible error of the depth in float32
  glm::dvec4 color{0.0};
  double colorDoubt = 0.0;  // possible change by snapped vertices, premultiplied
  bool exists = false;      // if false, it only counts for its doubt
  std::uint8_t doubts = 0;
};

double difference(const glm::dvec4& a, const glm::dvec4& b) {
  const glm::dvec3 d = glm::abs(glm::dvec3(a) - glm::dvec3(b));
  return std::max({d.r, d.g, d.b});
}

// Smaller changes of weights change a colour by less than half a step of 1/255: shading is at most
// twice as steep as the attributes.
constexpr double steepWeight = 0.5 / 255 / 2;

class RowRenderer {
 public:
  RowRenderer(const Scene& scene, const Shading& shading, const Projection& projection, double near)
      : scene_(scene), shading_(shading), projection_(projection), near_(near) {}

  void render(int y, std::span<const std::uint32_t> triangles, CpuImage& image) {
    opaque_.clear();
    transparent_.clear();
    for (const std::uint32_t id : triangles) collect(id, y);
    // Opaque: the depth test passes at equal depth, so the last submitted fragment stays.
    // Transparent: the lower primitive id is in front (shaders/common/order.glsl).
    std::ranges::sort(opaque_, [](const Fragment& a, const Fragment& b) {
      return std::tuple(a.x, -a.depth, ~a.id) < std::tuple(b.x, -b.depth, ~b.id);
    });
    std::ranges::sort(transparent_, [](const Fragment& a, const Fragment& b) {
      return std::tuple(a.x, -a.depth, a.id) < std::tuple(b.x, -b.depth, b.id);
    });
    std::span<const Fragment> opaque(opaque_), transparent(transparent_);
    const auto takePixel = [](std::span<const Fragment>& rest, int x) {
      const auto end = std::ranges::find_if(rest, [x](const Fragment& f) { return f.x != x; });
      const auto count = std::size_t(end - rest.begin());
      const auto taken = rest.first(count);
      rest = rest.subspan(count);
      return taken;
    };
    for (int x = 0; x < image.width; ++x)
      resolve(takePixel(opaque, x), takePixel(transparent, x), image.index(x, y), image);
  }

 private:
  void collect(std::uint32_t id, int y) {
    const glm::uvec3& corners = scene_.triangles[id];
    const Triangle triangle(projection_, corners);
    const PixelBox box = triangle.box(0.5 * near_);
    for (int x = box.x0; x < box.x1; ++x) {
      const Hit hit = triangle.at(x, y);
      if (!hit.covered && !hit.nearEdge) continue;
      Fragment f{.x = x, .id = id};
      f.depth = near_ / hit.distance;
      const glm::dvec3 w =
          glm::dvec3(projection_[corners.x].w, projection_[corners.y].w, projection_[corners.z].w) *
          projection_.unit();
      const double slope = (std::abs(glm::dot(hit.weightDx, w)) +  // relative, per pixel
                            std::abs(glm::dot(hit.weightDy, w))) /
                           hit.distance;
      f.depthDoubt = f.depth * (depthPrecision + Triangle::edgeDoubt * slope);
      f.exists = hit.covered && f.depth <= 1.0;  // there is nothing in front of the near plane
      if (hit.nearEdge || (hit.covered && std::abs(f.depth - 1.0) <= f.depthDoubt))
        f.doubts = doubt::edge;
      if (!f.exists && f.doubts == 0) continue;
      const Shaded shaded = shading_.shade(corners, hit);
      if (shaded.nearCutoff) f.doubts |= doubt::cutoff;
      f.exists = f.exists && !shaded.discarded;
      if (!f.exists && (f.doubts == 0 || (shaded.discarded && !shaded.nearCutoff))) continue;
      f.color = shaded.color;
      f.colorDoubt = colorDoubt(corners, hit, shaded.color);
      (scene_.alphaModeOf(corners) == AlphaMode::blend ? transparent_ : opaque_).push_back(f);
    }
  }

  // The change of the colour over the distance that snapping moves vertices, in both directions.
  double colorDoubt(const glm::uvec3& corners, const Hit& hit, const glm::dvec4& color) const {
    double changed = 0.0;
    for (const glm::dvec3& slope : {hit.weightDx, hit.weightDy}) {
      const glm::dvec3 step = Triangle::edgeDoubt * slope;
      if (std::abs(step.x) + std::abs(step.y) + std::abs(step.z) < steepWeight) continue;
      Hit moved = hit;
      moved.weight += step;
      const glm::dvec4 other = shading_.shade(corners, moved).color;
      const glm::dvec3 d = glm::abs(glm::dvec3(other) * other.a - glm::dvec3(color) * color.a);
      changed += std::max({d.r, d.g, d.b}) + std::abs(other.a - color.a);
    }
    return changed;
  }

  // The fragments of one pixel, in order.
  void resolve(std::span<const Fragment> opaque, std::span<const Fragment> transparent,
               std::size_t pixel, CpuImage& image) const {
    std::uint8_t doubts = 0;
    // Reversed depth: 0, the background, is infinitely far.
    Fragment background{.color = glm::dvec4(backgroundColor), .exists = true};
    const auto firstThere = std::ranges::find_if(opaque, &Fragment::exists);
    const Fragment& back = firstThere == opaque.end() ? background : *firstThere;
    for (const Fragment& f : opaque) {
      if (!mayBeInFrontOf(f, back)) break;
      doubts |= f.doubts;
      if (f.exists && tooCloseToOrder(f, back) && difference(f.color, back.color) > visible)
        doubts |= doubt::depthOrder;
    }

    glm::dvec3 color(0.0);
    double transmittance = 1.0;
    double swaps = 0.0;  // bound on the change by a wrong order
    double snapping = 0.0;
    double largestDoubt = 0.0;
    for (const Fragment& f : transparent) largestDoubt = std::max(largestDoubt, f.depthDoubt);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < transparent.size(); ++i) {
      const Fragment& f = transparent[i];
      if (mayBeInFrontOf(f, back)) doubts |= f.doubts;
      if (!f.exists) continue;
      const double alpha = f.color.a;
      if (tooCloseToOrder(f, back)) swaps += alpha * difference(f.color, back.color);
      if (f.depth < back.depth) continue;
      for (std::size_t j = i + 1; j < transparent.size() && swaps <= visible; ++j) {
        const Fragment& g = transparent[j];
        if (f.depth - g.depth > f.depthDoubt + largestDoubt) break;
        if (g.exists && tooCloseToOrder(f, g))
          swaps += transmittance * alpha * g.color.a * difference(f.color, g.color);
      }
      snapping += transmittance * f.colorDoubt;
      color += transmittance * alpha * glm::dvec3(f.color);
      transmittance *= 1.0 - alpha;
      ++count;
    }
    if (swaps > visible) doubts |= doubt::depthOrder;
    image.color[pixel] = glm::dvec4(color + transmittance * glm::dvec3(back.color), 1.0);
    image.fragments[pixel] = count;
    image.doubts[pixel] = doubts;
    image.snapping[pixel] = float(snapping + transmittance * back.colorDoubt);
  }

  static bool mayBeInFrontOf(const Fragment& a, const Fragment& b) {
    return a.depth + a.depthDoubt >= b.depth - b.depthDoubt;
  }

  // Copies of a triangle have the same float operations, so their depths are equal on every device.
  bool tooCloseToOrder(const Fragment& a, const Fragment& b) const {
    if (std::abs(a.depth - b.depth) > a.depthDoubt + b.depthDoubt) return false;
    for (int i = 0; i < 3; ++i)
      if (scene_.vertices[scene_.triangles[a.id][i]].position !=
          scene_.vertices[scene_.triangles[b.id][i]].position)
        return true;
    return false;
  }

  const Scene& scene_;
  const Shading& shading_;
  const Projection& projection_;
  double near_;
  std::vector<Fragment> opaque_, transparent_;
};

}  // namespace
}  // namespace cpu_reference

CpuImage renderOnCpu(const Scene& scene, const SceneAtlases& atlases, const Camera& camera,
                     int width, int height) {
  using namespace cpu_reference;
  const Projection projection(scene, camera, width, height);
  const Shading shading(scene, atlases);
  std::vector<std::vector<std::uint32_t>> trianglesOfRow(static_cast<std::size_t>(height));
  for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
    const PixelBox box = Triangle(projection, scene.triangles[id]).box(0.5 * double(camera.near));
    for (int y = box.y0; y < box.y1; ++y) trianglesOfRow[std::size_t(y)].push_back(id);
  }

  CpuImage image{width, height, {}, {}, {}, {}};
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  image.color.resize(pixels);
  image.fragments.resize(pixels);
  image.doubts.resize(pixels);
  image.snapping.resize(pixels);
  parallelFor(std::size_t(height), [&](std::size_t y) {
    RowRenderer(scene, shading, projection, double(camera.near))
        .render(int(y), trianglesOfRow[y], image);
  });
  return image;
}

CpuImage renderOnCpu(const Scene& scene, const Camera& camera, int width, int height) {
  return renderOnCpu(scene, buildAtlases(scene), camera, width, height);
}

std::uint64_t CpuImage::fragmentCount() const {
  return std::accumulate(fragments.begin(), fragments.end(), std::uint64_t(0));
}

std::uint64_t CpuImage::coveredPixels() const {
  return std::uint64_t(std::ranges::count_if(fragments, [](std::uint32_t n) { return n > 0; }));
}

std::uint32_t CpuImage::maxFragmentsPerPixel() const {
  return fragments.empty() ? 0 : *std::ranges::max_element(fragments);
}

std::uint64_t CpuImage::pixelsInDoubt(std::uint8_t bits) const {
  return std::uint64_t(
      std::ranges::count_if(doubts, [bits](std::uint8_t d) { return (d & bits) != 0; }));
}

Image CpuImage::toImage() const {
  Image image{.width = width, .height = height, .srgb = false, .rgba = {}};
  image.rgba.reserve(4 * color.size());
  for (const glm::dvec4& c : color)
    for (int i = 0; i < 4; ++i) image.rgba.push_back(float(c[i]));
  return image;
}

}  // namespace oitlab
