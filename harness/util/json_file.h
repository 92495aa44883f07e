#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace oitlab {

/// Writes indented JSON with writeFileAtomically(). NaN and infinity become null, because JSON has
/// neither. Bytes that are not UTF-8 (in a driver's name, say) become U+FFFD. Throws InputError
/// with the file's name when it cannot be written.
void writeJsonFile(const std::filesystem::path& path, const nlohmann::json& value);

/// Throws InputError with the file's name when it cannot be read, and with line, column and byte
/// when it is not JSON.
nlohmann::json readJsonFile(const std::filesystem::path& path);

}  // namespace oitlab
