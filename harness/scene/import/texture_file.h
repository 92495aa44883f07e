#pragma once

#include <filesystem>
#include <span>

#include "scene/scene.h"

namespace oitlab {

/// Decodes a PNG, JPEG or whatever else stb_image knows into `texture` as RGBA8; its name is left.
/// False when there is no image to be had from the bytes, or one larger than devices hold.
bool decodeTexture(std::span<const unsigned char> bytes, Texture& texture);

/// The same from a file, named after it. False when it is missing or unreadable.
bool readTexture(const std::filesystem::path& path, Texture& texture);

}  // namespace oitlab
