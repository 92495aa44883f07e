#pragma once

#include <array>

namespace oitlab {

/// The sRGB-encoded colour of t in [0, 1] (clamped): black, purple, orange, pale yellow. Equal
/// steps of t look like equal steps of lightness, also in grey and to the colour-blind.
std::array<float, 3> infernoColour(double t);

}  // namespace oitlab
