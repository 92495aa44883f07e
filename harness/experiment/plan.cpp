#include <charconv>

#include "experiment/run.h"
#include "image/hash.h"
#include "util/error.h"

namespace oitlab {
namespace {

std::string groupKey(const CellSpec& cell) {
  auto key = cell.identity();
  key.erase("method");
  key.erase("parameters");
  return key.dump();
}

/// Lower-case letters, digits, dots and dashes: safe on every file system.
std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool keep = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_';
    if (keep)
      out += char(std::tolower(static_cast<unsigned char>(c)));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out.substr(0, 80);
}

}  // namespace

Shard parseShard(const std::string& text) {
  Shard shard{0, 0};
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.index);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, shard.count);
    if (second.ec == std::errc() && second.ptr == end && shard.index >= 1 &&
        shard.index <= shard.count && shard.count <= 10000)
      return shard;
  }
  fail<InputError>("--shard {}: wanted i/n with 1 <= i <= n, such as 2/4", text);
}

std::vector<std::vector<CellSpec>> groupCells(const std::vector<CellSpec>& cells) {
  std::vector<std::vector<CellSpec>> groups;
  std::map<std::string, std::size_t> indexOf;
  for (const CellSpec& cell : cells) {
    const auto [it, isNew] = indexOf.emplace(groupKey(cell), groups.size());
    if (isNew) groups.emplace_back();
    groups[it->second].push_back(cell);
  }
  return groups;
}

std::vector<CellSpec> shardCells(const std::vector<CellSpec>& cells, Shard shard) {
  const auto groups = groupCells(cells);
  std::vector<CellSpec> mine;
  std::size_t position = 0;
  for (const auto& group : groups) {
    const bool dealSingly = groups.size() < shard.count;
    for (const CellSpec& cell : group) {
      if (position % shard.count == shard.index - 1) mine.push_back(cell);
      if (dealSingly) ++position;
    }
    if (!dealSingly) ++position;
  }
  return mine;
}

std::string cellId(const CellSpec& cell, const DeviceInfo& device) {
  auto identity = cell.identity();
  identity["device"] = {device.name, device.driver, device.driverInfo};
  const std::string text = identity.dump();
  return slug(cell.label()) + "-" + imageHash(std::as_bytes(std::span(text))).substr(0, 10);
}

}  // namespace oitlab
