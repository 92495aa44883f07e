#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace oitlab {

/// Quantile of `sorted` (ascending, not empty) for q in [0, 1], linear between order statistics
/// (type 7 of Hyndman and Fan 1996, numpy's default).
double quantileOfSorted(std::span<const double> sorted, double q);

/// A summary of the frame times (or stage times) of a cell, in the unit of the samples.
struct Summary {
  std::uint64_t count = 0;      ///< finite samples: all below is of these
  std::uint64_t notFinite = 0;  ///< NaN and infinite samples, left out
  double median = 0, q1 = 0, q3 = 0, mean = 0, min = 0, max = 0, p95 = 0;
  std::uint64_t blocks = 0;  ///< that have finite samples
  /// 95% interval of the median, low and high: bootstrap over blocks. None for fewer than
  /// fewestBlocks.
  std::optional<std::pair<double, double>> ci95;
};

/// Fewer blocks have no 95% interval. The widest one of a median that makes no assumption about the
/// distribution reaches from the least to the greatest of n values, and covers it with
/// 1 - 2^(1 - n): 0.9375 for n = 5, 0.969 for n = 6.
inline constexpr std::uint64_t fewestBlocks = 6;

/// Samples come in blocks (runs of frames without another cell in between), and frames of one block
/// are not independent; so the bootstrap draws whole blocks. `blockOf[i]` is the block of sample i;
/// both spans have equal length.
/// Percentile bootstrap of the median, `resamples` draws, deterministic from `seed`.
/// Zero samples give a Summary of zeros.
Summary summarize(std::span<const double> samples, std::span<const std::uint32_t> blockOf,
                  std::uint64_t seed = 1, int resamples = 1000);

}  // namespace oitlab
