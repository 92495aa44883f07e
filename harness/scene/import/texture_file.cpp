#include "scene/import/texture_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <stb_image.h>

namespace oitlab {
namespace {

constexpr int largestImage = 16384;  // texels per side; every device has images of this size

int sizeOf(std::span<const unsigned char> bytes) {
  return int(std::min<std::size_t>(bytes.size(), 0x7fffffff));
}

}  // namespace

std::uint64_t countTexels(std::span<const unsigned char> bytes) {
  int width = 0, height = 0, channels = 0;
  const int size = sizeOf(bytes);
  if (size == 0 || !stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) ||
      width > largestImage || height > largestImage)
    return 0;
  return std::uint64_t(width) * std::uint64_t(height);
}

bool decodeTexture(std::span<const unsigned char> bytes, Texture& texture) {
  int width = 0, height = 0, channels = 0;
  const int size = sizeOf(bytes);
  if (countTexels(bytes) == 0) return false;
  stbi_uc* texels = stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4);
  if (!texels) return false;
  texture.width = width;
  texture.height = height;
  texture.rgba.assign(texels, texels + 4 * std::size_t(width) * std::size_t(height));
  stbi_image_free(texels);
  return true;
}

bool readTexture(const std::filesystem::path& path, Texture& texture, SceneBudget& budget) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream stream(path, std::ios::binary);
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream), {}};
  texture.name = path.filename().string();
  budget.addTexels(countTexels(bytes), fmt::format("texture '{}'", texture.name));
  return decodeTexture(bytes, texture);
}

}  // namespace oitlab
