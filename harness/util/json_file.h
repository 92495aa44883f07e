#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace oitlab {

/// The value as text, with `indent` spaces per level, or on one line if it is negative. NaN and
/// infinity become null, because JSON has neither. Bytes that are not UTF-8 (in a file's or a
/// driver's name, say) become U+FFFD.
std::string jsonText(const nlohmann::json& value, int indent = 2);

/// Writes jsonText() with writeFileAtomically(). Throws InputError with the file's name when it
/// cannot be written.
void writeJsonFile(const std::filesystem::path& path, const nlohmann::json& value);

/// Throws InputError with the file's name when it cannot be read, and with line, column and byte
/// when it is not JSON.
nlohmann::json readJsonFile(const std::filesystem::path& path);

}  // namespace oitlab
