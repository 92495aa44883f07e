#include "quality/flip.h"

#include <algorithm>
#include <cmath>

#include "quality/display.h"
#include "quality/flip_color.h"
#include "quality/flip_feature.h"
#include "util/check.h"

namespace oitlab {
namespace {

Color3 colorAt(const Planes<float>& planes, std::size_t i) {
  return {planes[0].values[i], planes[1].values[i], planes[2].values[i]};
}

Plane<float> luminanceOf(const Planes<float>& rgb) {
  Plane<float> result(rgb[0].width, rgb[0].height);
  forEachPixel(result, [&](std::size_t i) { result.values[i] = luminance(colorAt(rgb, i)); });
  return result;
}

/// FLIP of linear sRGB in [0, 1] (Andersson et al. 2020, section 4).
Plane<float> flipMap(const Planes<float>& a, const Planes<float>& b, double pixelsPerDegree) {
  const Planes<float> colorA = perceivedColors(a, pixelsPerDegree);
  const Planes<float> colorB = perceivedColors(b, pixelsPerDegree);
  const Features featureA = detectFeatures(luminanceOf(a), pixelsPerDegree);
  const Features featureB = detectFeatures(luminanceOf(b), pixelsPerDegree);
  Plane<float> map(a[0].width, a[0].height);
  forEachPixel(map, [&](std::size_t i) {
    const float color = flipColorDifference(colorAt(colorA, i), colorAt(colorB, i));
    const float feature =
        flipFeatureDifference(featureA.edges.values[i], featureB.edges.values[i],
                              featureA.points.values[i], featureB.points.values[i]);
    // Section 4.3, eq. 11. Clamped, because rounding may leave [0, 1].
    map.values[i] = std::clamp(std::pow(color, 1 - feature), 0.0F, 1.0F);
  });
  return map;
}

Flip withMean(Plane<float> map) {
  double sum = 0;
  for (const float value : map.values) sum += value;
  const double count = double(std::max<std::size_t>(map.values.size(), 1));
  return {std::move(map), sum / count};
}

/// The ACES tone curve as a rational function, (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5): that of
/// Narkowicz 2015, with the usual exposure factor of 0.6 included.
constexpr double aces[6] = {2.51 * 0.36, 0.03 * 0.6, 0, 2.43 * 0.36, 0.59 * 0.6, 0.14};

float toneMap(float x) {
  constexpr auto k = [](int i) { return float(aces[i]); };
  // From here on the curve is constant to float precision, and larger squares would overflow.
  const float v = std::min(x, 1e9F);
  const float mapped = (k(0) * v * v + k(1) * v + k(2)) / (k(3) * v * v + k(4) * v + k(5));
  return std::clamp(mapped, 0.0F, 1.0F);
}

/// The inverse of the tone curve: the value that becomes `t`.
double inverseToneMap(double t) {
  const double a = aces[0] - t * aces[3];
  const double b = aces[1] - t * aces[4];
  const double c = aces[2] - t * aces[5];
  const double half = -0.5 * b / a;
  return half + std::sqrt(half * half - c / a);
}

Planes<float> exposeAndToneMap(Planes<float> planes, double exposure) {
  const auto scale = float(std::exp2(exposure));
  for (Plane<float>& plane : planes)
    forEachPixel(plane, [&](std::size_t i) { plane.values[i] = toneMap(plane.values[i] * scale); });
  return planes;
}

double medianOf(std::vector<float> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (double(*middle) + double(*std::max_element(values.begin(), middle)));
}

}  // namespace

Flip computeFlip(const Image& image, const Image& reference, double pixelsPerDegree) {
  OITLAB_CHECK(image.width == reference.width && image.height == reference.height);
  OITLAB_CHECK(pixelsPerDegree > 0);
  return withMean(flipMap(displayLinear(image), displayLinear(reference), pixelsPerDegree));
}

ExposureRange flipExposures(const Image& reference) {
  std::vector<float> values = luminanceOf(sceneLinear(reference)).values;
  const float largest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  if (!(largest > 0)) return {};
  double median = medianOf(values);
  if (!(median > 0)) {
    std::erase_if(values, [](float value) { return !(value > 0); });
    median = medianOf(values);
  }
  const double bright = inverseToneMap(0.85);
  ExposureRange range{std::log2(bright / double(largest)), std::log2(bright / median), 2};
  range.count = std::max(2, int(std::ceil(range.last - range.first)));
  return range;
}

Flip computeHdrFlip(const Image& image, const Image& reference, double pixelsPerDegree) {
  OITLAB_CHECK(image.width == reference.width && image.height == reference.height);
  OITLAB_CHECK(pixelsPerDegree > 0);
  const Planes<float> a = sceneLinear(image), b = sceneLinear(reference);
  const ExposureRange range = flipExposures(reference);
  Plane<float> largest(image.width, image.height);
  for (int i = 0; i < range.count; ++i) {
    const double exposure = range.first + (range.last - range.first) * i / (range.count - 1);
    const Plane<float> map =
        flipMap(exposeAndToneMap(a, exposure), exposeAndToneMap(b, exposure), pixelsPerDegree);
    forEachPixel(map, [&](std::size_t p) {
      largest.values[p] = std::max(largest.values[p], map.values[p]);
    });
  }
  return withMean(std::move(largest));
}

}  // namespace oitlab
