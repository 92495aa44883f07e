#pragma once

#include <optional>

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

/// In smaller images no pixel has its whole window inside the image.
inline constexpr int minSsimSide = 11;

/// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) of display values: Gaussian window
/// of sigma 1.5 cut at radius 5, K1 = 0.01, K2 = 0.03, range 1, population covariances. The same
/// number as scikit-image's structural_similarity(gaussian_weights=True, sigma=1.5,
/// use_sample_covariance=False, channel_axis=-1, data_range=1) of the sRGB-encoded images: the mean
/// over R, G and B and over the pixels whose whole window lies within the image.
struct Ssim {
  /// For each pixel the mean over R, G and B, in [-1, 1]; 1 where the windows are equal. Within 5
  /// pixels of an edge the window contains repeated values of the edge.
  Plane<double> map;
  /// Empty when a side has fewer than minSsimSide pixels.
  std::optional<double> mean;
};

/// Linear images are clamped to [0, 1] and sRGB-encoded first. NaN and infinity count as 0; the
/// caller has to check for them. Symmetric. Sizes must be equal (checked).
Ssim computeSsim(const Image& image, const Image& reference);

}  // namespace oitlab
