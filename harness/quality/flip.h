#pragma once

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

/// Pixels per degree of visual angle of the observer in the FLIP papers: a 4K display that is 0.7 m
/// wide, seen from 0.7 m (Andersson et al. 2020, section 6).
inline constexpr double flipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

/// The result of FLIP: a value in [0, 1] per pixel, which is 0 where an observer who flips between
/// the two images sees no difference, and its mean. Filters repeat the edge of an image beyond it.
struct Flip {
  Plane<float> map;
  double mean = 0;
};

/// FLIP of what a display shows (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild
/// 2020). Linear images are clamped to [0, 1]. Symmetric. NaN and infinity count as 0; the caller
/// has to check for them. `pixelsPerDegree` > 0. Sizes must be equal (checked).
Flip computeFlip(const Image& image, const Image& reference,
                 double pixelsPerDegree = flipPixelsPerDegree);

/// The exposures of HDR-FLIP, in stops.
struct ExposureRange {
  double first = 0;  ///< makes the brightest pixel of the reference 0.85 of white
  double last = 0;   ///< makes its median pixel 0.85 of white
  int count = 2;     ///< evenly spaced, both ends included
};

/// The range of exposures for the luminances of `reference`, which is linear (Andersson et al.
/// 2021, section 3). If the median is 0, the median of the pixels that are not black is used. For a
/// black image both ends are 0.
ExposureRange flipExposures(const Image& reference);

/// HDR-FLIP of two linear images (Andersson, Nilsson, Shirley, Akenine-Moller 2021): for each pixel
/// the largest FLIP over a range of exposures, tone mapped with ACES. It is not symmetric, because
/// the range is that of the reference. Negative values count as 0; the rest is as in computeFlip().
Flip computeHdrFlip(const Image& image, const Image& reference,
                    double pixelsPerDegree = flipPixelsPerDegree);

}  // namespace oitlab
