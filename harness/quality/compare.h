#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

/// How far an image is from a reference. The first five are over the RGB channels of all pixels,
/// values as given (8-bit images divided by 255; linear for EXR); when one image is sRGB-encoded
/// and the other is linear, the encoded one is decoded first. SSIM and FLIP are of what a display
/// shows: linear images are clamped to [0, 1] and sRGB-encoded first.
struct Comparison {
  double rmse = 0;       ///< root of the mean squared difference
  double psnr = 0;       ///< 10 log10(1 / mse) in dB, peak 1; infinity when the images are equal,
                         ///< minus infinity when rmse is infinite (JSON knows neither)
  double maxError = 0;   ///< largest absolute difference of a channel
  double pixelsOff = 0;  ///< share of pixels with a channel off by more than 1/255, in [0, 1];
                         ///< one step of an 8-bit image is not more, whatever the rounding
  std::uint64_t pixelsOffCount = 0;

  // Means over pixels. None of them is a number when a pixel of either image is NaN or infinite:
  // a mean would hide it.
  std::optional<double> ssim;  ///< 1 = equal (quality/ssim.h); empty below 11 pixels on a side
  std::optional<double> flip;  ///< LDR-FLIP in [0, 1], 0 = no visible difference (quality/flip.h)
  std::optional<double> flipHdr;  ///< HDR-FLIP in [0, 1]; empty unless both images are linear
};

/// Compares two images of equal size. A NaN or infinity in either counts as off, with an error of
/// infinity. Throws InputError when the sizes differ, naming both.
Comparison compareImages(const Image& image, const Image& reference);

/// What an error map shows, per pixel. All are 0 where the images are equal, infinity where either
/// is NaN or infinite.
enum class MapMetric {
  absolute,  ///< largest absolute channel difference, values as in Comparison
  flip,      ///< LDR-FLIP, [0, 1]
  flipHdr,   ///< HDR-FLIP, [0, 1]; for two linear images
  ssim,      ///< 1 - SSIM, [0, 2]
};

/// "abs", "flip", "flip_hdr", "ssim". parse throws InputError with the names there are.
MapMetric parseMapMetric(const std::string& name);
std::vector<std::string> mapMetricNames();

/// The error of each pixel. Throws InputError when the sizes differ, or when HDR-FLIP is asked for
/// of an image that is not linear.
Plane<float> errorPlane(const Image& image, const Image& reference, MapMetric metric);

/// A picture of one number a pixel: a perceptually ordered colour map (dark = 0), scaled so that
/// `scale` (> 0) is its brightest colour, with a legend bar below that shows 0 and `scale`. What is
/// not finite is pure green, which the map does not have. The result is sRGB-encoded; it is higher
/// than the plane by the legend, and at least 64 pixels wide (padded in grey).
Image drawMap(const Plane<float>& values, float scale);

/// The numbers themselves as a grey linear image, for EXR files.
Image planeImage(const Plane<float>& values);

/// Writes the plane: .png as drawMap() with `scale`, .exr as planeImage(). Throws InputError as
/// writeImage() does.
void writeMap(const std::filesystem::path& path, const Plane<float>& values, float scale);

/// The largest value that is finite, or `least` when none is larger: a scale for drawMap().
float largestFinite(const Plane<float>& values, float least);

/// drawMap() of the absolute error.
Image errorMap(const Image& image, const Image& reference, float scale);

}  // namespace oitlab
