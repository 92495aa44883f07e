#pragma once

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

/// Pixels per degree of visual angle of the observer that FLIP's papers assume: a 4K display 0.7 m
/// wide, seen from 0.7 m (Andersson et al. 2020, section 6).
inline constexpr double kFlipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

/// What FLIP gives: per pixel, in [0, 1], 0 where an observer who flips between the two images sees
/// no difference; and its mean. Beyond its edges an image goes on with its edge.
struct Flip {
  Plane<float> map;
  double mean = 0;
};

/// FLIP of what a display shows (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild
/// 2020). Linear images are clamped to [0, 1], which is what encoding them as sRGB and showing them
/// comes to. Symmetric. NaN and infinity count as 0, so that the caller has to look for them.
/// `pixelsPerDegree` > 0. Sizes must be equal (checked).
Flip computeFlip(const Image& image, const Image& reference,
                 double pixelsPerDegree = kFlipPixelsPerDegree);

/// The exposures, in stops, that HDR-FLIP looks at.
struct ExposureRange {
  double first = 0;  ///< the brightest pixel of the reference is as bright as 0.85 of white
  double last = 0;   ///< its median pixel is
  int count = 2;     ///< evenly spaced, both ends included
};

/// The range of Andersson et al. 2021, section 3, for the luminances of `reference` (linear). A
/// median of 0 has no exposure: then it is that of the pixels that are not black; for a black image
/// both ends are 0.
ExposureRange flipExposures(const Image& reference);

/// HDR-FLIP (Andersson, Nilsson, Shirley, Akenine-Moller 2021) of two linear images: per pixel the
/// largest FLIP over a range of exposures of both, tone mapped with ACES. The range is that of the
/// reference: not symmetric. Negative values count as 0, the rest is as in computeFlip().
Flip computeHdrFlip(const Image& image, const Image& reference,
                    double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace oitlab
