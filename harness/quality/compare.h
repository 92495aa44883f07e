#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

/// How much an image differs from a reference. The first five are over the RGB channels of all
/// pixels, with the values as given: 8-bit images divided by 255, EXR images linear. If one image
/// is sRGB-encoded and the other is linear, the encoded one is decoded first. SSIM and FLIP compare
/// what a display shows: linear images are clamped to [0, 1] and sRGB-encoded first.
struct Comparison {
  double rmse = 0;       ///< root of the mean squared difference
  double psnr = 0;       ///< 10 log10(1 / mse) in dB, peak 1; infinity when the images are equal,
                         ///< minus infinity when rmse is infinite (JSON has neither)
  double maxError = 0;   ///< largest absolute difference of a channel
  double pixelsOff = 0;  ///< share of pixels of which a channel differs by more than 1/255, in [0,
                         ///< 1]; a single step of an 8-bit image is never more, despite rounding
  std::uint64_t pixelsOffCount = 0;

  // Means over pixels. All of them are NaN when a pixel of either image is NaN or infinite, because
  // the mean would hide it.
  std::optional<double> ssim;  ///< 1 = equal (quality/ssim.h); empty below 11 pixels on a side
  std::optional<double> flip;  ///< LDR-FLIP in [0, 1], 0 = no visible difference (quality/flip.h)
  std::optional<double> flipHdr;  ///< HDR-FLIP in [0, 1]; empty unless both images are linear
};

/// Compares two images of equal size. A NaN or infinity in either of them is a difference of
/// infinity. Throws InputError with both sizes when they differ.
Comparison compareImages(const Image& image, const Image& reference);

/// What an error map shows for each pixel. It is 0 where the images are equal, and infinity where
/// one of them is NaN or infinite.
enum class MapMetric {
  absolute,  ///< largest absolute channel difference, values as in Comparison
  flip,      ///< LDR-FLIP, [0, 1]
  flipHdr,   ///< HDR-FLIP, [0, 1]; for two linear images
  ssim,      ///< 1 - SSIM, [0, 2]
};

/// "abs", "flip", "flip_hdr", "ssim", and back. Parsing throws InputError with the list of names.
MapMetric parseMapMetric(const std::string& name);
std::vector<std::string> mapMetricNames();

/// The error of each pixel. Throws InputError when the sizes differ, and for HDR-FLIP when an image
/// is not linear.
Plane<float> errorPlane(const Image& image, const Image& reference, MapMetric metric);

/// A picture of one number per pixel in a perceptually ordered colour map, from dark at 0 to the
/// brightest colour at `scale` (> 0), with a legend below. Values that are not finite are pure
/// green, which is not in the map. The result is sRGB-encoded. It is higher than the plane by the
/// legend, and padded with grey to a width of at least 64 pixels.
Image drawMap(const Plane<float>& values, float scale);

/// The numbers as a linear grey image, for EXR files.
Image planeImage(const Plane<float>& values);

/// Writes the plane: a .png with drawMap() and `scale`, an .exr with planeImage(). Throws what
/// writeImage() throws.
void writeMap(const std::filesystem::path& path, const Plane<float>& values, float scale);

/// The largest finite value, or `least` if that is larger: a scale for drawMap().
float largestFinite(const Plane<float>& values, float least);

/// drawMap() of the absolute error.
Image errorMap(const Image& image, const Image& reference, float scale);

}  // namespace oitlab
