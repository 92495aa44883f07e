#pragma once

#include <cstdint>

#include "image/image.h"

namespace oitlab {

/// How far an image is from a reference. All over the RGB channels of all pixels; values as given
/// (8-bit images divided by 255; linear for EXR). When one image is sRGB-encoded and the other is
/// linear, the encoded one is decoded first.
struct Comparison {
  double rmse = 0;       ///< root of the mean squared difference
  double psnr = 0;       ///< 10 log10(1 / mse) in dB, peak 1; infinity when the images are equal,
                         ///< minus infinity when rmse is infinite (JSON knows neither)
  double maxError = 0;   ///< largest absolute difference of a channel
  double pixelsOff = 0;  ///< share of pixels with a channel off by more than 1/255, in [0, 1];
                         ///< one step of an 8-bit image is not more, whatever the rounding
  std::uint64_t pixelsOffCount = 0;
};

/// Compares two images of equal size. A NaN or infinity in either counts as off, with an error of
/// infinity. Throws InputError when the sizes differ, naming both.
Comparison compareImages(const Image& image, const Image& reference);

/// A picture of the largest absolute channel difference per pixel: a perceptually ordered colour
/// map (dark = equal), scaled so that `scale` (> 0) is its brightest colour, with a legend bar
/// below that shows 0 and `scale`. Pixels that are NaN or infinite in either image are pure green,
/// which the map does not have. The result is sRGB-encoded; it is higher than the images by the
/// legend, and at least 64 pixels wide (padded in grey). Throws InputError when the sizes differ.
Image errorMap(const Image& image, const Image& reference, float scale);

}  // namespace oitlab
