// Decodes BC1 and BC3 (Khronos Data Format Specification 1.3, sections 18.1 and 18.3).
#include <algorithm>
#include <array>

#include "scene/atlas.h"
#include "util/check.h"

namespace oitlab {
namespace {

using Rgb = std::array<int, 3>;

Rgb from565(unsigned c) {
  const int r = int(c >> 11), g = int((c >> 5) & 63), b = int(c & 31);
  return {(r << 3) | (r >> 2), (g << 2) | (g >> 4), (b << 3) | (b >> 2)};
}

Rgb mix(const Rgb& a, int weightA, const Rgb& b, int weightB) {
  const int sum = weightA + weightB;
  Rgb mixed;
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = (weightA * a[c] + weightB * b[c] + sum / 2) / sum;
  return mixed;
}

// With `bc1` the order of the end points may select the mode with three colours and black.
void decodeColor(const std::uint8_t* block, bool bc1, std::uint8_t (&texels)[16][4]) {
  const unsigned c0 = block[0] | block[1] << 8, c1 = block[2] | block[3] << 8;
  std::array<Rgb, 4> palette{from565(c0), from565(c1)};
  if (!bc1 || c0 > c1) {
    palette[2] = mix(palette[0], 2, palette[1], 1);
    palette[3] = mix(palette[0], 1, palette[1], 2);
  } else {
    palette[2] = mix(palette[0], 1, palette[1], 1);
    palette[3] = {0, 0, 0};
  }
  for (unsigned i = 0; i < 16; ++i) {
    const Rgb& color = palette[(block[4 + i / 4] >> (2 * (i % 4))) & 3u];
    for (std::size_t c = 0; c < 3; ++c) texels[i][c] = std::uint8_t(color[c]);
    texels[i][3] = 255;
  }
}

void decodeAlpha(const std::uint8_t* block, std::uint8_t (&texels)[16][4]) {
  const int a0 = block[0], a1 = block[1];
  const int steps = a0 > a1 ? 7 : 5;
  std::array<int, 8> palette{a0, a1, 0, 0, 0, 0, 0, 255};
  for (int i = 1; i < steps; ++i)
    palette[std::size_t(i + 1)] = ((steps - i) * a0 + i * a1 + steps / 2) / steps;
  std::uint64_t bits = 0;
  for (int i = 0; i < 6; ++i) bits |= std::uint64_t(block[2 + i]) << (8 * i);
  for (int i = 0; i < 16; ++i) texels[i][3] = std::uint8_t(palette[(bits >> (3 * i)) & 7u]);
}

}  // namespace

std::vector<std::uint8_t> decodeAtlasLevel(const Atlas& atlas, std::size_t index) {
  OITLAB_CHECK_OP(index, <, atlas.levels.size());
  const Atlas::Level& level = atlas.levels[index];
  const auto width = std::size_t(level.width), height = std::size_t(level.height);
  std::vector<std::uint8_t> rgba(width * height * 4);
  const std::uint8_t* block = level.blocks.data();
  for (std::size_t y = 0; y < height; y += 4)
    for (std::size_t x = 0; x < width; x += 4) {
      std::uint8_t texels[16][4];
      decodeColor(block + (atlas.alpha ? 8 : 0), !atlas.alpha, texels);
      if (atlas.alpha) decodeAlpha(block, texels);
      for (std::size_t row = 0; row < 4; ++row)
        std::copy_n(texels[4 * row], 16, &rgba[((y + row) * width + x) * 4]);
      block += atlas.alpha ? 16 : 8;
    }
  return rgba;
}

}  // namespace oitlab
