#include "scene/import/texture_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <stb_image.h>

namespace oitlab {
namespace {

constexpr int largestImage = 16384;  // texels per side; every device has images of this size

}  // namespace

bool decodeTexture(std::span<const unsigned char> bytes, Texture& texture) {
  int width = 0, height = 0, channels = 0;
  const int size = int(std::min<std::size_t>(bytes.size(), 0x7fffffff));
  if (size == 0 || !stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) ||
      width > largestImage || height > largestImage)
    return false;
  stbi_uc* texels = stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4);
  if (!texels) return false;
  texture.width = width;
  texture.height = height;
  texture.rgba.assign(texels, texels + 4 * std::size_t(width) * std::size_t(height));
  stbi_image_free(texels);
  return true;
}

bool readTexture(const std::filesystem::path& path, Texture& texture) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream stream(path, std::ios::binary);
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream), {}};
  texture.name = path.filename().string();
  return decodeTexture(bytes, texture);
}

}  // namespace oitlab
