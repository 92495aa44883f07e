#pragma once

#include <filesystem>
#include <functional>
#include <limits>

#include "experiment/experiment.h"

namespace oitlab {

/// "2/4": the second of four shares.
struct Shard {
  std::uint32_t index = 1, count = 1;
};

/// Throws InputError unless `text` is i/n with 1 <= i <= n <= 10000.
Shard parseShard(const std::string& text);

/// The cells of one shard. Cells that are measured against each other (same scene, view, size and
/// format) stay together, so that their ratios are paired; only when there are fewer such groups
/// than shards are single cells dealt out. The shards' union is the whole, without overlap.
std::vector<CellSpec> shardCells(const std::vector<CellSpec>& cells, Shard shard);

/// Groups in the order of their first cell; each is measured interleaved.
std::vector<std::vector<CellSpec>> groupCells(const std::vector<CellSpec>& cells);

/// The name of a cell's file: readable, and unique by a hash of its identity and the device.
std::string cellId(const CellSpec& cell, const DeviceInfo& device);

struct RunSummary {
  std::size_t done = 0, failed = 0, skipped = 0;
  std::size_t present = 0;       ///< were there before
  std::size_t otherVersion = 0;  ///< of those, made by another commit of oitlab
  std::size_t left = 0;          ///< not begun, because the time was over
};

/// Measures the cells that `results` does not hold yet. One JSON file a cell in results/cells, its
/// picture in results/images, each under a temporary name until complete: a killed run loses only
/// what was being measured. A cell that cannot be measured is written with the reason. After
/// `seconds` no further group of cells is begun: what has been is measured in full, so that another
/// run can go on from there. Throws InputError, before anything is measured, when the folder cannot
/// be written or a size is beyond the device.
RunSummary runExperiment(const Device& device, const Experiment& experiment,
                         const std::vector<CellSpec>& cells, const std::filesystem::path& results,
                         double seconds = std::numeric_limits<double>::infinity());

}  // namespace oitlab
