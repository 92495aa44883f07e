#pragma once

#include "quality/plane.h"

namespace oitlab {

/// The strength of edges and of points at each pixel: lengths of gradients, in [0, 1].
struct Features {
  Plane<float> edges, points;
};

/// The feature detectors of FLIP (Andersson et al. 2020, section 4.2.1) on linear luminance in
/// [0, 1]: first and second derivatives of a Gaussian as wide as the eye's edge detector.
Features detectFeatures(const Plane<float>& luminance, double pixelsPerDegree);

/// The feature difference of one pixel (section 4.2.2), in [0, 1].
float flipFeatureDifference(float edgeA, float edgeB, float pointA, float pointB);

}  // namespace oitlab
