#pragma once

#include <array>
#include <cstddef>

#include "image/image.h"

namespace oitlab {

/// The difference of two images, pixel by pixel: what compareImages sums and errorMap shows. Keeps
/// references: both images must outlive it.
class Difference {
 public:
  /// Throws InputError when the sizes differ, naming both.
  Difference(const Image& image, const Image& reference);

  std::size_t pixelCount() const { return image_.rgba.size() / 4; }

  /// |image - reference| of R, G and B; infinity where either is NaN or infinite. When one image is
  /// sRGB-encoded and the other is linear, the encoded one is decoded first.
  std::array<double, 3> at(std::size_t pixel) const;

  /// The largest of the three.
  double largestAt(std::size_t pixel) const;

 private:
  const Image& image_;
  const Image& reference_;
};

}  // namespace oitlab
