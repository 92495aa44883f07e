#include "quality/color_map.h"

#include <algorithm>

namespace oitlab {
namespace {

/// Every 17th of the 256 entries of 'inferno' by Nathaniel Smith and Stefan van der Walt
/// (matplotlib, CC0), rounded to 8 bits. Linear interpolation between them deviates from the other
/// entries by at most 6 / 255.
constexpr int colors[16][3] = {{0, 0, 4},      {12, 8, 38},    {36, 12, 79},   {66, 10, 104},
                               {93, 18, 110},  {120, 28, 109}, {147, 38, 103}, {174, 48, 92},
                               {199, 62, 76},  {221, 81, 58},  {237, 105, 37}, {248, 133, 15},
                               {252, 165, 10}, {250, 198, 45}, {242, 230, 97}, {252, 255, 164}};

}  // namespace

std::array<float, 3> infernoColor(double t) {
  const double place = std::clamp(t, 0.0, 1.0) * 15;
  const int below = std::min(int(place), 14);
  const double share = place - below;
  std::array<float, 3> color{};
  for (int c = 0; c < 3; ++c)
    color[c] = float((colors[below][c] * (1 - share) + colors[below + 1][c] * share) / 255.0);
  return color;
}

}  // namespace oitlab
