#pragma once

#include "quality/plane.h"

namespace oitlab {

/// A colour as three numbers: linear sRGB, CIE XYZ, or one of the opponent spaces below.
using Colour3 = std::array<float, 3>;

/// Relative luminance (CIE Y) of linear sRGB with white (1, 1, 1) at 1.
float luminance(const Colour3& rgb);

/// Linear sRGB to YCxCz, CIELAB without its cube roots, and back; white is (100, 0, 0).
Colour3 toYCxCz(const Colour3& rgb);
Colour3 fromYCxCz(const Colour3& yCxCz);

/// Linear sRGB to CIELAB (D65), its chroma scaled by lightness for Hunt's effect: bright colours
/// look more colourful (Andersson et al. 2020, eq. 5).
Colour3 toHuntLab(const Colour3& rgb);

/// The HyAB distance (Abasi et al. 2020): city-block in lightness, Euclidean in chroma.
float hyAb(const Colour3& a, const Colour3& b);

/// The colour pipeline of FLIP (Andersson et al. 2020, section 4.1), first half: linear sRGB in
/// [0, 1] is filtered by the contrast sensitivity functions of an observer who sees
/// `pixelsPerDegree`, and becomes Hunt-adjusted CIELAB.
Planes<float> perceivedColours(const Planes<float>& rgb, double pixelsPerDegree);

/// Second half: the colour difference of two such colours, in [0, 1].
float flipColourDifference(const Colour3& a, const Colour3& b);

}  // namespace oitlab
