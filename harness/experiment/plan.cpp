#include "experiment/plan.h"

#include <charconv>

#include "util/error.h"

namespace oitlab {

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
    const auto [it, isNew] = indexOf.emplace(cell.groupIdentity().dump(), groups.size());
    if (isNew) groups.emplace_back();
    groups[it->second].push_back(cell);
  }
  return groups;
}

std::vector<CellSpec> shardCells(const std::vector<CellSpec>& cells, Shard shard) {
  const auto groups = groupCells(cells);
  std::vector<CellSpec> mine;
  for (std::size_t i = shard.index - 1; i < groups.size(); i += shard.count)
    mine.insert(mine.end(), groups[i].begin(), groups[i].end());
  return mine;
}

}  // namespace oitlab
