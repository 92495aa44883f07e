#include "image/image.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "image/codec.h"
#include "util/check.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

constexpr std::int64_t maxSide = 32768;
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION  // libFuzzer's name for a build under it
constexpr std::int64_t maxPixels = std::int64_t(1) << 16;
#else
constexpr std::int64_t maxPixels = std::int64_t(1) << 27;
#endif

enum class Format { png, exr };

Format formatOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".png") return Format::png;
  if (extension == ".exr") return Format::exr;
  fail<InputError>("{}: unknown image extension '{}', wanted .png or .exr", path.string(),
                   path.extension().string());
}

}  // namespace

void checkImageSize(std::int64_t width, std::int64_t height, const std::string& name) {
  const bool sidesFit = width >= 1 && height >= 1 && width <= maxSide && height <= maxSide;
  if (sidesFit && width * height <= maxPixels) return;
  fail<InputError>("{}: image of {} x {} pixels, wanted 1 to {} on a side and at most {} in all",
                   name, width, height, maxSide, maxPixels);
}

void checkImagePath(const std::filesystem::path& path) {
  formatOf(path);
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    fail<InputError>("{}: there is no folder {} to write it to", path.string(), folder.string());
}

Image readImage(const std::filesystem::path& path) {
  // The extension is checked first, before a large file is read.
  const Format format = formatOf(path);
  checkRegularFile(path);
  const std::string bytes = readTextFile(path);
  return format == Format::png ? decodePng(bytes, path.string()) : decodeExr(bytes, path.string());
}

void writeImage(const std::filesystem::path& path, const Image& image) {
  const Format format = formatOf(path);
  checkImageSize(image.width, image.height, path.string());
  OITLAB_CHECK_OP(image.rgba.size(), ==, std::size_t(image.width) * image.height * 4);
  writeFileAtomically(path, format == Format::png ? encodePng(image, path.string())
                                                  : encodeExr(image, path.string()));
}

// IEC 61966-2-1.
float srgbEncode(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float srgbDecode(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace oitlab
