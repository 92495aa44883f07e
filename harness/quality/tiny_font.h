#pragma once

#include <array>
#include <string_view>

#include "image/image.h"

namespace oitlab {

/// Numbers in pictures: digits, '.', '-', '+' and 'e' (other characters are blank), 3 x 5 cells a
/// character with one column between, each cell `scale` pixels on a side.
int tinyTextWidth(std::string_view text, int scale);
int tinyTextHeight(int scale);

/// Draws with the upper left corner at (x, y); what lies outside of the image is clipped.
void drawTinyText(Image& image, int x, int y, int scale, std::string_view text,
                  const std::array<float, 3>& colour);

}  // namespace oitlab
