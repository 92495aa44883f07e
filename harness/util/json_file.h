#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace oitlab {

/// Writes indented JSON through a temporary name (see writeFileAtomically). NaN and infinities
/// become null, since JSON has neither; bytes that are not UTF-8 (a driver's name) become U+FFFD.
/// Throws InputError naming the file when it cannot be written.
void writeJsonFile(const std::filesystem::path& path, const nlohmann::json& value);

/// Throws InputError naming the file when it cannot be read; with line, column and byte when it is
/// not JSON.
nlohmann::json readJsonFile(const std::filesystem::path& path);

}  // namespace oitlab
