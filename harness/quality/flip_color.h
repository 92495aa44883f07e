#pragma once

#include "quality/plane.h"

namespace oitlab {

/// A colour as three numbers: linear sRGB, CIE XYZ, or one of the opponent spaces below.
using Color3 = std::array<float, 3>;

/// Relative luminance (CIE Y) of linear sRGB with white (1, 1, 1) at 1.
float luminance(const Color3& rgb);

/// Linear sRGB to YCxCz, which is CIELAB without the cube roots, and back. White is (100, 0, 0).
Color3 toYCxCz(const Color3& rgb);
Color3 fromYCxCz(const Color3& yCxCz);

/// Linear sRGB to CIELAB (D65) with the chroma scaled by lightness, because bright colours look
/// more colourful: the Hunt effect (Andersson et al. 2020, eq. 5).
Color3 toHuntLab(const Color3& rgb);

/// The HyAB distance (Abasi et al. 2020): city-block in lightness, Euclidean in chroma.
float hyAb(const Color3& a, const Color3& b);

/// The first half of FLIP's colour pipeline (Andersson et al. 2020, section 4.1). It filters linear
/// sRGB in [0, 1] by the contrast sensitivity functions of an observer who sees `pixelsPerDegree`,
/// and converts it to Hunt-adjusted CIELAB.
Planes<float> perceivedColors(const Planes<float>& rgb, double pixelsPerDegree);

/// The second half: the difference of two such colours, in [0, 1].
float flipColorDifference(const Color3& a, const Color3& b);

}  // namespace oitlab
