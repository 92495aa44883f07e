#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace oitlab {

/// A texture during filtering: RGBA, linear, 16 bits, not premultiplied. 16 linear bits distinguish
/// all 8-bit sRGB codes, and averages of integers are the same on every machine.
struct LinearImage {
  using Texel = std::array<std::uint16_t, 4>;

  int width = 0;
  int height = 0;
  std::vector<Texel> texels;

  const Texel& at(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

/// Decodes a texture. With `alpha` false the result is opaque.
LinearImage linearImage(const Texture& texture, bool alpha);

/// Half the size (rounded up, at least 1). Each texel is the mean of four. Colours are weighted by
/// alpha, so that invisible texels do not tint visible ones.
LinearImage halved(const LinearImage& image);

/// `width` by `height` texels of the endlessly repeated image, from texel (-border, -border) on.
LinearImage repeated(const LinearImage& image, int border, int width, int height);

/// A texel as an 8-bit texture stores it: sRGB-encoded colour, linear alpha.
std::array<std::uint8_t, 4> encodeTexel(const LinearImage::Texel& texel);

}  // namespace oitlab
