#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace oitlab {

/// A cache holds what can be made again, so nothing about it is an error: what cannot be read, or
/// is not exactly what was written for this key, counts as missing.

/// What writeCached() put into the file `path` under `key`. Empty where there is no such regular
/// file, where it cannot be read, and where its checksum over key and content does not fit: a
/// damaged file, one that another key wrote, or one of another version of this format.
std::optional<std::string> readCached(const std::filesystem::path& path, std::string_view key);

/// Writes `content` under `key` to the file `path`, whose folder is made where it is missing. The
/// file appears whole or not at all, so that several processes can share a cache. Returns whether
/// it was written.
bool writeCached(const std::filesystem::path& path, std::string_view key, std::string_view content);

}  // namespace oitlab
