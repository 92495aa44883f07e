#pragma once

#include <filesystem>
#include <span>

#include "scene/scene.h"

namespace oitlab {

/// Decodes a PNG, a JPEG or any other format of stb_image into `texture` as RGBA8. Keeps its name.
/// False when the bytes are not an image, or one larger than devices support.
bool decodeTexture(std::span<const unsigned char> bytes, Texture& texture);

/// The same for a file; the texture has its name. False when it is missing or unreadable.
bool readTexture(const std::filesystem::path& path, Texture& texture);

}  // namespace oitlab
