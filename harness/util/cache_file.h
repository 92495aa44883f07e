#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace oitlab {

// A cache contains only data that can be made again. So nothing about it is an error: a file that
// cannot be read, or that is not exactly what was written for its key, counts as missing.

/// The content that writeCached() wrote to the file `path` under `key`. Empty when `path` is not a
/// regular file, when it cannot be read, and when the checksum over key and content does not match:
/// the file is damaged, was written under another key, or by another version of this format.
std::optional<std::string> readCached(const std::filesystem::path& path, std::string_view key);

/// Writes `content` under `key` to the file `path`, and makes its folder if it is missing. The file
/// appears complete or not at all, so that several processes can share a cache. Returns whether it
/// was written.
bool writeCached(const std::filesystem::path& path, std::string_view key, std::string_view content);

}  // namespace oitlab
