#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace oitlab {

/// An image in main memory: float32 RGBA, rows top to bottom. Colours are linear, or with `srgb` as
/// an 8-bit file stores them: sRGB-encoded, divided by 255.
struct Image {
  int width = 0;
  int height = 0;
  bool srgb = false;
  std::vector<float> rgba;  ///< width * height * 4

  const float* at(int x, int y) const { return rgba.data() + 4 * (std::size_t(y) * width + x); }
  float* at(int x, int y) { return rgba.data() + 4 * (std::size_t(y) * width + x); }
};

/// Reads .png (8 or 16 bit; stays sRGB-encoded) or .exr (half or float; linear). Throws InputError
/// with the file's name and the fault.
Image readImage(const std::filesystem::path& path);

/// Writes .png (8-bit RGB, sRGB-encoded; without alpha, because targets contain the opaque
/// background) or .exr (float RGBA, linear, zip). The file is written under a temporary name beside
/// the target and renamed, so that no half-written file is left. Throws InputError when the
/// extension is another one or the file cannot be written.
void writeImage(const std::filesystem::path& path, const Image& image);

/// Throws InputError unless `path` has an extension of writeImage() and its folder exists. For
/// checks before the image is made.
void checkImagePath(const std::filesystem::path& path);

/// The sRGB transfer function and its inverse, on [0, 1].
float srgbEncode(float linear);
float srgbDecode(float encoded);

}  // namespace oitlab
