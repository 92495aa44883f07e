#include "util/json_file.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

/// The part after the prefix: "[json.exception.parse_error.101] parse error at line 1, column 2: ".
std::string_view reasonOf(std::string_view message) {
  const std::size_t place = message.find(", column ");
  const std::size_t colon = message.find(": ", place == message.npos ? 0 : place);
  return colon == message.npos ? message : message.substr(colon + 2);
}

}  // namespace

std::string jsonText(const nlohmann::json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

void writeJsonFile(const std::filesystem::path& path, const nlohmann::json& value) {
  constexpr int indent = 1;  // results are many and small
  writeFileAtomically(path, jsonText(value, indent) + '\n');
}

nlohmann::json readJsonFile(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    // The byte counts from 1. It is the last one that was read; for a text that ends too early it
    // is one beyond the end.
    const std::size_t offset = std::min(text.size(), error.byte == 0 ? 0 : error.byte - 1);
    const std::string_view before = std::string_view(text).substr(0, offset);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t lineStart = before.rfind('\n') + 1;  // npos + 1 is 0
    fail<InputError>("{}:{}:{}: not valid JSON at byte {}: {}", path.string(), line,
                     offset - lineStart + 1, offset + 1, reasonOf(error.what()));
  }
}

}  // namespace oitlab
