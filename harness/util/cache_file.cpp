#include "util/cache_file.h"

#include <cstdint>
#include <cstring>

#include <xxhash.h>

#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

// The file is this header and then the content. A cache is only read on the machine that wrote it,
// so numbers are in the machine's own byte order.
struct Header {
  char magic[8] = {'o', 'i', 't', 'c', 'a', 'c', 'h', '1'};
  std::uint64_t contentBytes = 0;
  std::uint64_t checksum = 0;  // XXH3 of key and content
};
static_assert(sizeof(Header) == 24);

std::uint64_t checksumOf(std::string_view key, std::string_view content) {
  const std::uint64_t ofKey = XXH3_64bits(key.data(), key.size());
  return XXH3_64bits_withSeed(content.data(), content.size(), ofKey);
}

}  // namespace

std::optional<std::string> readCached(const std::filesystem::path& path, std::string_view key) {
  // Reading anything but a regular file may never end (a device) or never start (a FIFO).
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  std::string file;
  try {
    file = readTextFile(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
  Header header;
  if (file.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, file.data(), sizeof header);
  file.erase(0, sizeof header);
  if (std::memcmp(header.magic, Header().magic, sizeof header.magic) != 0 ||
      header.contentBytes != file.size() || header.checksum != checksumOf(key, file))
    return std::nullopt;
  return file;
}

bool writeCached(const std::filesystem::path& path, std::string_view key,
                 std::string_view content) {
  Header header;
  header.contentBytes = content.size();
  header.checksum = checksumOf(key, content);
  std::string file(reinterpret_cast<const char*>(&header), sizeof header);
  file += content;
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  try {
    writeFileAtomically(path, file);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace oitlab
