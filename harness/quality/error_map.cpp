#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "quality/color_map.h"
#include "quality/compare.h"
#include "quality/difference.h"
#include "quality/flip.h"
#include "quality/ssim.h"
#include "quality/tiny_font.h"
#include "util/check.h"
#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

using Color = std::array<float, 3>;

constexpr std::pair<const char*, MapMetric> metrics[] = {{"abs", MapMetric::absolute},
                                                         {"flip", MapMetric::flip},
                                                         {"flip_hdr", MapMetric::flipHdr},
                                                         {"ssim", MapMetric::ssim}};

/// Not in the colour map: a value that is not finite must not look like a large error.
constexpr Color notFinite = {0, 1, 0};
/// The frame of the legend must not look like an error of 0.
constexpr Color paper = {0.2F, 0.2F, 0.2F};
constexpr Color ink = {1, 1, 1};

/// Narrower maps are padded, because the legend needs room for its numbers.
constexpr int minWidth = 64;

void setPixel(Image& map, int x, int y, const Color& color) {
  std::copy(color.begin(), color.end(), map.at(x, y));
}

Image makePaper(int width, int height) {
  Image map{width, height, /*srgb=*/true,
            std::vector<float>(std::size_t(width) * std::size_t(height) * 4, 1.0F)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) setPixel(map, x, y, paper);
  return map;
}

/// Draws "0 ======= 0.05" in the rows from `top` on.
void drawLegend(Image& map, int top, int unit, const std::string& label) {
  const int y = top + 2 * unit;
  const int height = tinyTextHeight(unit);
  const int labelX = map.width - 2 * unit - tinyTextWidth(label, unit);
  drawTinyText(map, 2 * unit, y, unit, "0", ink);
  drawTinyText(map, labelX, y, unit, label, ink);
  const int left = 2 * unit + tinyTextWidth("0", unit) + 2 * unit;
  const int right = labelX - 2 * unit;
  for (int x = left; x < right; ++x)
    for (int row = 0; row < height; ++row)
      setPixel(map, x, y + row, infernoColor((x - left) / std::max(1.0, right - left - 1.0)));
}

}  // namespace

MapMetric parseMapMetric(const std::string& name) {
  const auto found = std::find_if(std::begin(metrics), std::end(metrics),
                                  [&](const auto& metric) { return metric.first == name; });
  if (found == std::end(metrics))
    fail<InputError>("no error map is called '{}'{}, wanted one of {}", name,
                     didYouMean(name, mapMetricNames()), joinNames(mapMetricNames()));
  return found->second;
}

std::vector<std::string> mapMetricNames() {
  std::vector<std::string> names;
  for (const auto& [name, metric] : metrics) names.emplace_back(name);
  return names;
}

Plane<float> errorPlane(const Image& image, const Image& reference, MapMetric metric) {
  const Difference difference(image, reference);
  if (metric == MapMetric::flipHdr && (image.srgb || reference.srgb))
    fail<InputError>("HDR-FLIP is of two linear images (.exr), found an sRGB-encoded one");
  Plane<float> plane(image.width, image.height);
  if (metric == MapMetric::flip) plane = computeFlip(image, reference).map;
  if (metric == MapMetric::flipHdr) plane = computeHdrFlip(image, reference).map;
  if (metric == MapMetric::ssim) {
    const Ssim ssim = computeSsim(image, reference);
    // Rounding must not make the difference of equal windows negative.
    std::transform(ssim.map.values.begin(), ssim.map.values.end(), plane.values.begin(),
                   [](double similarity) { return float(std::max(0.0, 1 - similarity)); });
  }
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    const double error = difference.largestAt(i);
    if (metric == MapMetric::absolute || !std::isfinite(error)) plane.values[i] = float(error);
  }
  return plane;
}

Image drawMap(const Plane<float>& values, float scale) {
  OITLAB_CHECK(scale > 0 && std::isfinite(scale));
  // The legend grows with the picture, so that it is legible when the picture is shown reduced.
  const int unit = std::clamp(values.width / 320, 1, 6);
  const int legendHeight = tinyTextHeight(unit) + 4 * unit;

  Image map = makePaper(std::max(values.width, minWidth), values.height + legendHeight);
  for (int y = 0; y < values.height; ++y)
    for (int x = 0; x < values.width; ++x) {
      const float value = values.row(y)[x];
      setPixel(map, x, y, std::isfinite(value) ? infernoColor(double(value) / scale) : notFinite);
    }
  drawLegend(map, values.height, unit, fmt::format("{:.3g}", scale));
  return map;
}

Image planeImage(const Plane<float>& values) {
  Image image{values.width, values.height, /*srgb=*/false, {}};
  image.rgba.reserve(4 * values.values.size());
  for (const float value : values.values)
    image.rgba.insert(image.rgba.end(), {value, value, value, 1.0F});
  return image;
}

void writeMap(const std::filesystem::path& path, const Plane<float>& values, float scale) {
  const std::string extension = path.extension().string();
  const bool raw = extension == ".exr" || extension == ".EXR";
  writeImage(path, raw ? planeImage(values) : drawMap(values, scale));
}

float largestFinite(const Plane<float>& values, float least) {
  for (const float value : values.values)
    if (std::isfinite(value)) least = std::max(least, value);
  return least;
}

Image errorMap(const Image& image, const Image& reference, float scale) {
  return drawMap(errorPlane(image, reference, MapMetric::absolute), scale);
}

}  // namespace oitlab
