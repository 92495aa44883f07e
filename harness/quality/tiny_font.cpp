#include "quality/tiny_font.h"

#include <algorithm>

namespace oitlab {
namespace {

constexpr int glyphColumns = 3;
constexpr int glyphRows = 5;

/// Five octal digits, one per row from the top. The bits of a digit are the columns.
int glyphOf(char c) {
  constexpr int digitBits[10] = {075557, 026227, 071747, 071317, 055711,
                                 074717, 074757, 071244, 075757, 075717};
  if (c >= '0' && c <= '9') return digitBits[c - '0'];
  switch (c) {
    case '.':
      return 000002;
    case '-':
      return 000700;
    case '+':
      return 002720;
    case 'e':
      return 074647;  // drawn as E, because a lower-case e needs more than three columns
    default:
      return 0;
  }
}

void fillCell(Image& image, int x, int y, int size, const std::array<float, 3>& color) {
  for (int py = std::max(y, 0); py < std::min(y + size, image.height); ++py)
    for (int px = std::max(x, 0); px < std::min(x + size, image.width); ++px)
      std::copy(color.begin(), color.end(), image.at(px, py));
}

}  // namespace

int tinyTextWidth(std::string_view text, int scale) {
  return text.empty() ? 0 : (int(text.size()) * (glyphColumns + 1) - 1) * scale;
}

int tinyTextHeight(int scale) {
  return glyphRows * scale;
}

void drawTinyText(Image& image, int x, int y, int scale, std::string_view text,
                  const std::array<float, 3>& color) {
  for (const char c : text) {
    const int glyph = glyphOf(c);
    for (int row = 0; row < glyphRows; ++row)
      for (int column = 0; column < glyphColumns; ++column) {
        const int bit = (glyphRows - 1 - row) * glyphColumns + (glyphColumns - 1 - column);
        if (glyph >> bit & 1) fillCell(image, x + column * scale, y + row * scale, scale, color);
      }
    x += (glyphColumns + 1) * scale;
  }
}

}  // namespace oitlab
