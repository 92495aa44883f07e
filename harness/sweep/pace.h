#pragma once

#include <filesystem>

#include "measure/measure.h"

namespace oitlab {

/// The size of a group of cells, as far as its duration depends on it.
struct GroupSize {
  std::size_t cells = 0;
  double megapixels = 0;  ///< of one image
};

/// Predicts how long measuring takes. Two parts: the blocks of the cells, and the overhead (scenes,
/// pipelines, the reference, scoring). What is known beforehand are limits; the rest is learned
/// from group to group, and kept from run to run.
class Pace {
 public:
  Pace(const MeasureSettings& settings, bool isCpu);

  /// Seconds of a group that is not begun.
  double secondsOf(const GroupSize& group) const;

  /// Seconds left of a group that has been going on for `elapsed` seconds, with each of its cells
  /// at `progress`; empty while none has begun.
  double secondsLeft(const GroupSize& group, const std::vector<MeasureProgress>& progress,
                     double elapsed) const;

  /// A group took `seconds`, with its cells at `progress` in the end.
  void learn(const GroupSize& group, const std::vector<MeasureProgress>& progress, double seconds);

  /// What was learned, in a file of the cache for each device. A file that is not there or broken
  /// is no error, nor is one that cannot be written.
  void load(const std::filesystem::path& file);
  void save(const std::filesystem::path& file) const;

 private:
  double cellSeconds() const;
  double secondsLeft(const MeasureProgress& cell) const;
  double overhead(const GroupSize& group) const;

  /// Blocks that a cell takes where each lasts `blockSeconds`.
  double blocksOf(double blockSeconds) const;

  MeasureSettings settings_;
  bool isCpu_;
  // Sums over the groups so far; as much as one typical group is assumed before the first.
  double cells_ = 0, cellBlocks_ = 0, cellSeconds_ = 0;
  double overheadSeconds_ = 0, overheadModel_ = 0;
};

}  // namespace oitlab
