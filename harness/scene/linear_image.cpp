#include "scene/linear_image.h"

#include <algorithm>
#include <cmath>

#include "image/image.h"

namespace oitlab {
namespace {

std::array<std::uint16_t, 256> makeDecodeTable() {
  std::array<std::uint16_t, 256> table;
  for (int code = 0; code < 256; ++code)
    table[std::size_t(code)] =
        std::uint16_t(std::lround(65535.0f * srgbDecode(float(code) / 255.0f)));
  return table;
}

std::vector<std::uint8_t> makeEncodeTable() {
  std::vector<std::uint8_t> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = std::uint8_t(std::lround(255.0f * srgbEncode(float(i) / 65535.0f)));
  return table;
}

}  // namespace

LinearImage linearImage(const Texture& texture, bool alpha) {
  static const std::array<std::uint16_t, 256> decode = makeDecodeTable();
  LinearImage image{texture.width, texture.height, {}};
  image.texels.resize(texture.rgba.size() / 4);
  const std::uint8_t* from = texture.rgba.data();
  for (LinearImage::Texel& texel : image.texels) {
    texel = {decode[from[0]], decode[from[1]], decode[from[2]],
             std::uint16_t(alpha ? 257 * from[3] : 65535)};
    from += 4;
  }
  return image;
}

LinearImage halved(const LinearImage& image) {
  LinearImage half{(image.width + 1) / 2, (image.height + 1) / 2, {}};
  half.texels.reserve(std::size_t(half.width) * std::size_t(half.height));
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const int x1 = std::min(2 * x + 1, image.width - 1),
                y1 = std::min(2 * y + 1, image.height - 1);
      std::uint64_t color[3] = {}, weights = 0;
      for (const LinearImage::Texel* texel : {&image.at(2 * x, 2 * y), &image.at(x1, 2 * y),
                                              &image.at(2 * x, y1), &image.at(x1, y1)}) {
        // The weight is alpha plus one: where all four texels are invisible they still need a
        // colour, because bilinear filtering mixes it into visible neighbours.
        const std::uint64_t weight = (*texel)[3] + 1u;
        for (int c = 0; c < 3; ++c) color[c] += weight * (*texel)[c];
        weights += weight;
      }
      const auto mean = [&](std::uint64_t sum) {
        return std::uint16_t((sum + weights / 2) / weights);
      };
      half.texels.push_back(
          {mean(color[0]), mean(color[1]), mean(color[2]), std::uint16_t((weights - 4 + 2) / 4)});
    }
  return half;
}

LinearImage repeated(const LinearImage& image, int border, int width, int height) {
  LinearImage result{width, height, {}};
  result.texels.reserve(std::size_t(width) * std::size_t(height));
  const auto wrap = [](int i, int size) { return (i % size + size) % size; };
  for (int y = 0; y < height; ++y) {
    const int fromY = wrap(y - border, image.height);
    for (int x = 0; x < width; ++x)
      result.texels.push_back(image.at(wrap(x - border, image.width), fromY));
  }
  return result;
}

std::array<std::uint8_t, 4> encodeTexel(const LinearImage::Texel& texel) {
  static const std::vector<std::uint8_t> encode = makeEncodeTable();
  return {encode[texel[0]], encode[texel[1]], encode[texel[2]],
          std::uint8_t((texel[3] + 128u) / 257u)};
}

}  // namespace oitlab
