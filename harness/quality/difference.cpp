#include "quality/difference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "util/error.h"

namespace oitlab {

Difference::Difference(const Image& image, const Image& reference)
    : image_(image), reference_(reference) {
  if (image.width == reference.width && image.height == reference.height) return;
  fail<InputError>("image of {} x {} pixels against a reference of {} x {}, wanted equal sizes",
                   image.width, image.height, reference.width, reference.height);
}

std::array<double, 3> Difference::at(std::size_t pixel) const {
  const bool mixed = image_.srgb != reference_.srgb;
  const auto channel = [&](const Image& from, std::size_t c) {
    const float value = from.rgba[4 * pixel + c];
    return mixed && from.srgb ? srgbDecode(value) : value;
  };
  std::array<double, 3> difference{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double a = channel(image_, c);
    const double b = channel(reference_, c);
    // Two infinities must not cancel out, and comparisons with NaN are false, so both are tested.
    const bool measurable = std::isfinite(a) && std::isfinite(b);
    difference[c] = measurable ? std::abs(a - b) : std::numeric_limits<double>::infinity();
  }
  return difference;
}

double Difference::largestAt(std::size_t pixel) const {
  const auto [r, g, b] = at(pixel);
  return std::max({r, g, b});
}

}  // namespace oitlab
