#include "quality/compare.h"

#include <algorithm>
#include <cmath>

#include "quality/difference.h"
#include "quality/flip.h"
#include "quality/ssim.h"

namespace oitlab {
namespace {

/// One step of an 8-bit image. As floats, two neighbouring steps may be up to 6e-8 farther apart.
/// Without the margin it would depend on the step whether one step counts as more than one.
constexpr double oneStep = 1.0 / 255.0 + 1e-6;

}  // namespace

Comparison compareImages(const Image& image, const Image& reference) {
  const Difference difference(image, reference);
  const std::size_t pixels = difference.pixelCount();
  Comparison result;
  double squares = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto channels = difference.at(i);
    for (const double error : channels) squares += error * error;
    const double largest = *std::max_element(channels.begin(), channels.end());
    result.maxError = std::max(result.maxError, largest);
    if (largest > oneStep) ++result.pixelsOffCount;
  }
  const double mse = pixels == 0 ? 0 : squares / double(3 * pixels);
  result.rmse = std::sqrt(mse);
  result.psnr = -10.0 * std::log10(mse);
  result.pixelsOff = pixels == 0 ? 0 : double(result.pixelsOffCount) / double(pixels);
  if (pixels == 0 || !std::isfinite(result.maxError)) return result;
  const bool linear = !image.srgb && !reference.srgb;
  if (result.maxError == 0 && image.srgb == reference.srgb) {
    // Exact methods give equal images in many cells; these need no filters.
    if (std::min(image.width, image.height) >= minSsimSide) result.ssim = 1;
    result.flip = 0;
    if (linear) result.flipHdr = 0;
    return result;
  }
  result.ssim = computeSsim(image, reference).mean;
  result.flip = computeFlip(image, reference).mean;
  if (linear) result.flipHdr = computeHdrFlip(image, reference).mean;
  return result;
}

}  // namespace oitlab
