#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "quality/colour_map.h"
#include "quality/compare.h"
#include "quality/difference.h"
#include "quality/tiny_font.h"
#include "util/check.h"

namespace oitlab {
namespace {

using Colour = std::array<float, 3>;

/// Outside of the colour map: an error that is not a number must not pass for a large one.
constexpr Colour kNotFinite = {0, 1, 0};
/// Neither does the frame of the legend look like an error of 0.
constexpr Colour kPaper = {0.2F, 0.2F, 0.2F};
constexpr Colour kInk = {1, 1, 1};

/// Narrower maps are padded: the legend has to have room for its numbers.
constexpr int kMinWidth = 64;

void setPixel(Image& map, int x, int y, const Colour& colour) {
  std::copy(colour.begin(), colour.end(), map.at(x, y));
}

Image makePaper(int width, int height) {
  Image map{width, height, /*srgb=*/true,
            std::vector<float>(std::size_t(width) * std::size_t(height) * 4, 1.0F)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) setPixel(map, x, y, kPaper);
  return map;
}

/// "0 ======= 0.05" in the rows from `top` on.
void drawLegend(Image& map, int top, int unit, const std::string& label) {
  const int y = top + 2 * unit;
  const int height = tinyTextHeight(unit);
  const int labelX = map.width - 2 * unit - tinyTextWidth(label, unit);
  drawTinyText(map, 2 * unit, y, unit, "0", kInk);
  drawTinyText(map, labelX, y, unit, label, kInk);
  const int left = 2 * unit + tinyTextWidth("0", unit) + 2 * unit;
  const int right = labelX - 2 * unit;
  for (int x = left; x < right; ++x)
    for (int row = 0; row < height; ++row)
      setPixel(map, x, y + row, infernoColour((x - left) / std::max(1.0, right - left - 1.0)));
}

}  // namespace

Image errorMap(const Image& image, const Image& reference, float scale) {
  OITLAB_CHECK(scale > 0 && std::isfinite(scale));
  const Difference difference(image, reference);
  // The legend grows with the picture, which is looked at as a whole.
  const int unit = std::clamp(image.width / 320, 1, 6);
  const int legendHeight = tinyTextHeight(unit) + 4 * unit;

  Image map = makePaper(std::max(image.width, kMinWidth), image.height + legendHeight);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double error = difference.largestAt(std::size_t(y) * image.width + x);
      setPixel(map, x, y, std::isfinite(error) ? infernoColour(error / scale) : kNotFinite);
    }
  drawLegend(map, image.height, unit, fmt::format("{:.3g}", scale));
  return map;
}

}  // namespace oitlab
