#pragma once

#include <array>
#include <cstddef>

#include "image/image.h"

namespace oitlab {

/// The difference of two images, pixel by pixel. compareImages() sums it and errorMap() shows it.
/// It refers to both images, which must outlive it.
class Difference {
 public:
  /// Throws InputError with both sizes when they differ.
  Difference(const Image& image, const Image& reference);

  std::size_t pixelCount() const { return image_.rgba.size() / 4; }

  /// |image - reference| of R, G and B; infinity where one of them is NaN or infinite. If one image
  /// is sRGB-encoded and the other is linear, the encoded one is decoded first.
  std::array<double, 3> at(std::size_t pixel) const;

  /// The largest of the three.
  double largestAt(std::size_t pixel) const;

 private:
  const Image& image_;
  const Image& reference_;
};

}  // namespace oitlab
