#pragma once

#include <filesystem>
#include <span>

#include "scene/import/budget.h"
#include "scene/scene.h"

namespace oitlab {

/// Texels of the image that decodeTexture() would make of the bytes. 0 where it would make none.
std::uint64_t countTexels(std::span<const unsigned char> bytes);

/// Decodes a PNG, a JPEG or any other format of stb_image into `texture` as RGBA8. Keeps its name.
/// False when the bytes are not an image, or one larger than devices support.
bool decodeTexture(std::span<const unsigned char> bytes, Texture& texture);

/// The same for a file; the texture has its name. False when it is missing or unreadable. Throws
/// InputError when its texels are beyond the budget.
bool readTexture(const std::filesystem::path& path, Texture& texture, SceneBudget& budget);

}  // namespace oitlab
