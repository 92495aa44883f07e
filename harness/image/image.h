#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace oitlab {

/// An image in main memory: float32 RGBA, rows top to bottom. Colours are linear unless `srgb` says
/// that they are as an 8-bit file stored them (sRGB-encoded, divided by 255).
struct Image {
  int width = 0;
  int height = 0;
  bool srgb = false;
  std::vector<float> rgba;  ///< width * height * 4

  const float* at(int x, int y) const { return rgba.data() + 4 * (std::size_t(y) * width + x); }
  float* at(int x, int y) { return rgba.data() + 4 * (std::size_t(y) * width + x); }
};

/// Reads .png (8 or 16 bit; kept sRGB-encoded) or .exr (half or float; linear).
/// Throws InputError naming the file and what is wrong with it.
Image readImage(const std::filesystem::path& path);

/// Writes .png (8-bit RGB, sRGB-encoded from linear unless `image.srgb`; alpha dropped, since
/// targets hold the opaque background) or .exr (float RGBA, linear, zip). Written to a temporary
/// name beside the target and renamed, so that no half-written file is left. Throws InputError when
/// the extension is neither or the file cannot be written.
void writeImage(const std::filesystem::path& path, const Image& image);

/// Throws InputError unless `path` can be given to writeImage(): a known extension, in a folder
/// that exists. Said before the work rather than after it.
void checkImagePath(const std::filesystem::path& path);

/// The sRGB transfer function and its inverse, on [0, 1].
float srgbEncode(float linear);
float srgbDecode(float encoded);

}  // namespace oitlab
