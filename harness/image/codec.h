#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "image/image.h"

// The two file formats of readImage() and writeImage(). No other file includes this. The functions
// work on bytes in memory, so that errors of the file system and of the format are handled
// separately. `name` is the file's name for messages.
namespace oitlab {

/// Both throw InputError with the file's name when the bytes are not a complete image of the
/// format.
Image decodePng(std::string_view bytes, const std::string& name);
Image decodeExr(std::string_view bytes, const std::string& name);

std::string encodePng(const Image& image, const std::string& name);
std::string encodeExr(const Image& image, const std::string& name);

/// Rejects the sizes of damaged or hostile headers before memory is allocated for them: throws
/// InputError unless each side is from 1 to 32768 and there are at most 2^27 pixels (2 GiB of
/// floats).
void checkImageSize(std::int64_t width, std::int64_t height, const std::string& name);

}  // namespace oitlab
