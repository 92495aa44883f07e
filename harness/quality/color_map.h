#pragma once

#include <array>

namespace oitlab {

/// The sRGB-encoded colour for t in [0, 1] (clamped): black, purple, orange, pale yellow. Equal
/// steps of t look like equal steps of lightness, in grey and to colour-blind readers too.
std::array<float, 3> infernoColor(double t);

}  // namespace oitlab
