#pragma once

#include <array>
#include <string_view>

#include "image/image.h"

namespace oitlab {

/// A font for numbers in pictures: digits, '.', '-', '+' and 'e'; other characters are blank. A
/// character has 3 x 5 cells and one column of space, and a cell is `scale` pixels wide.
int tinyTextWidth(std::string_view text, int scale);
int tinyTextHeight(int scale);

/// Draws with the upper left corner at (x, y). Clips at the edges of the image.
void drawTinyText(Image& image, int x, int y, int scale, std::string_view text,
                  const std::array<float, 3>& color);

}  // namespace oitlab
