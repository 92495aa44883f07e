#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "image/image.h"

/// The two file formats behind readImage and writeImage; nothing else includes this. They work on
/// bytes in memory, so that the errors of files and of formats are met apart. `name` is the file,
/// for messages.
namespace oitlab {

/// Both throw InputError naming the file when the bytes are not a complete image of their format.
Image decodePng(std::string_view bytes, const std::string& name);
Image decodeExr(std::string_view bytes, const std::string& name);

std::string encodePng(const Image& image, const std::string& name);
std::string encodeExr(const Image& image, const std::string& name);

/// Refuses a size that only a broken or hostile header has, before anything is allocated for it:
/// throws InputError unless 1 <= side <= 32768 and there are at most 2^27 pixels (2 GiB of floats).
void checkImageSize(std::int64_t width, std::int64_t height, const std::string& name);

}  // namespace oitlab
