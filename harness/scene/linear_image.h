#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace oitlab {

/// A texture while it is filtered: RGBA, linear, 16 bits, not premultiplied. 16 linear bits keep
/// every 8-bit sRGB code apart, and integers average the same on every machine.
struct LinearImage {
  using Texel = std::array<std::uint16_t, 4>;

  int width = 0;
  int height = 0;
  std::vector<Texel> texels;

  const Texel& at(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

/// Decodes; with `alpha` false all is opaque.
LinearImage linearImage(const Texture& texture, bool alpha);

/// Half the size (rounded up, at least 1), each texel the mean of four. Colours are weighted by
/// alpha, so that what cannot be seen does not tint what can.
LinearImage halved(const LinearImage& image);

/// `width` by `height` texels of the image repeated for ever, from texel (-border, -border).
LinearImage repeated(const LinearImage& image, int border, int width, int height);

/// A texel as an 8-bit texture stores it: sRGB-encoded colour, linear alpha.
std::array<std::uint8_t, 4> encodeTexel(const LinearImage::Texel& texel);

}  // namespace oitlab
