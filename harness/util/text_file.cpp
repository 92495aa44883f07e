#include "util/text_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>

#include "util/error.h"

namespace oitlab {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// A name that is hidden and has its own extension, so that `*.json` does not match it. It is
/// random, because many processes and machines may write into one folder, and short, however long
/// the target's name is.
std::filesystem::path temporaryBeside(const std::filesystem::path& path) {
  std::random_device random;
  const std::uint64_t id = (std::uint64_t(random()) << 32) | random();
  return path.parent_path() / fmt::format(".oitlab-{:016x}.tmp", id);
}

/// Returns whether everything was written; if not, errno is set.
bool writeNewFile(const std::filesystem::path& path, std::string_view bytes) {
  File file(std::fopen(path.c_str(), "wbx"));
  if (!file) return false;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  // A full disk may only be noticed when the buffer is flushed.
  return written && std::fflush(file.get()) == 0;
}

}  // namespace

std::string readTextFile(const std::filesystem::path& path) {
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail<InputError>("{}: cannot be opened: {}", path.string(), std::strerror(errno));
  std::string bytes;
  char chunk[1 << 16];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file.get()))
    bytes.append(chunk, count);
  // A folder can be opened like a file, and reading it fails here.
  if (std::ferror(file.get()))
    fail<InputError>("{}: cannot be read: {}", path.string(), std::strerror(errno));
  return bytes;
}

void checkRegularFile(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_regular_file(status)) return;
  if (error) fail<InputError>("{}: cannot be opened: {}", path.string(), error.message());
  fail<InputError>("{}: is not a regular file", path.string());
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path temporary = temporaryBeside(path);
  const bool done =
      writeNewFile(temporary, bytes) && std::rename(temporary.c_str(), path.c_str()) == 0;
  if (done) return;
  const int reason = errno;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  fail<InputError>("{}: cannot be written: {}", path.string(), std::strerror(reason));
}

}  // namespace oitlab
