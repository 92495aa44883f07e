#pragma once

#include <cstdint>
#include <span>
#include <string>
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
  double ciLow = 0, ciHigh = 0;  ///< 95% interval of the median: bootstrap over blocks
};

/// Samples come in blocks (runs of frames without another cell in between), and frames of one block
/// are not independent; so the bootstrap draws whole blocks. `blockOf[i]` is the block of sample i;
/// both spans have equal length. With a single block the interval is that of the frames in it.
/// Percentile bootstrap of the median, `resamples` draws, deterministic from `seed`.
/// Zero samples give a Summary of zeros.
Summary summarize(std::span<const double> samples, std::span<const std::uint32_t> blockOf,
                  std::uint64_t seed = 1, int resamples = 1000);

}  // namespace oitlab
