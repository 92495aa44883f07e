#pragma once

#include "experiment/cell.h"

namespace oitlab {

/// "2/4": the second of four shares.
struct Shard {
  std::uint32_t index = 1, count = 1;
};

/// Throws InputError unless `text` is i/n with 1 <= i <= n <= 10000.
Shard parseShard(const std::string& text);

/// Cells that are measured in turn: those of the same scene, view, size and format. Groups are in
/// the order of their first cell.
std::vector<std::vector<CellSpec>> groupCells(const std::vector<CellSpec>& cells);

/// The cells of one shard. Groups are dealt out whole, so that the ratios within a group stay those
/// of one run: with more shards than groups the surplus shards get nothing. The shards' union is
/// the whole, without overlap.
std::vector<CellSpec> shardCells(const std::vector<CellSpec>& cells, Shard shard);

}  // namespace oitlab
