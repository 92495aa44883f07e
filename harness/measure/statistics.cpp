#include "measure/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "util/check.h"

namespace oitlab {
namespace {

/// Steele, Lea and Flood 2014. The standard's distributions differ between libraries; an interval
/// must not.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  /// Uniform in [0, bound) but for a bias below bound / 2^32.
  std::size_t below(std::size_t bound) { return std::size_t((next() >> 32) * bound >> 32); }

 private:
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

/// The finite samples in ascending order, each with its block, numbered from 0.
struct Ranked {
  std::vector<double> values;
  std::vector<std::uint32_t> blocks;
  std::size_t blockCount = 0;
};

Ranked rank(std::span<const double> samples, std::span<const std::uint32_t> blockOf) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (std::isfinite(samples[i])) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return samples[a] < samples[b]; });

  std::vector<std::uint32_t> blocks;
  for (const std::size_t i : order) blocks.push_back(blockOf[i]);
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());

  Ranked ranked;
  ranked.blockCount = blocks.size();
  for (const std::size_t i : order) {
    const auto block = std::lower_bound(blocks.begin(), blocks.end(), blockOf[i]);
    ranked.blocks.push_back(std::uint32_t(block - blocks.begin()));
    ranked.values.push_back(samples[i]);
  }
  return ranked;
}

/// The median when each value occurs as often as its block was drawn: a walk up the sorted values,
/// so that no draw needs a sort of its own.
double medianOfDraw(const Ranked& ranked, const std::vector<std::uint32_t>& timesDrawn) {
  std::uint64_t total = 0;
  for (const std::uint32_t block : ranked.blocks) total += timesDrawn[block];
  const std::uint64_t lowerRank = (total - 1) / 2;
  const std::uint64_t upperRank = total / 2;
  std::uint64_t passed = 0;
  double lower = 0;
  for (std::size_t i = 0; i < ranked.values.size(); ++i) {
    const std::uint64_t next = passed + timesDrawn[ranked.blocks[i]];
    if (passed <= lowerRank && lowerRank < next) lower = ranked.values[i];
    if (upperRank < next) return (lower + ranked.values[i]) / 2;
    passed = next;
  }
  return lower;
}

std::vector<double> bootstrapMedians(const Ranked& ranked, std::uint64_t seed, int resamples) {
  SplitMix64 random(seed);
  std::vector<double> medians;
  std::vector<std::uint32_t> timesDrawn(ranked.blockCount);
  for (int r = 0; r < resamples; ++r) {
    std::fill(timesDrawn.begin(), timesDrawn.end(), 0);
    for (std::size_t i = 0; i < ranked.blockCount; ++i)
      ++timesDrawn[random.below(ranked.blockCount)];
    medians.push_back(medianOfDraw(ranked, timesDrawn));
  }
  std::sort(medians.begin(), medians.end());
  return medians;
}

}  // namespace

double quantileOfSorted(std::span<const double> sorted, double q) {
  OITLAB_CHECK(!sorted.empty());
  OITLAB_CHECK(q >= 0 && q <= 1);
  const double place = q * double(sorted.size() - 1);
  const auto below = std::size_t(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - double(below));
}

Summary summarize(std::span<const double> samples, std::span<const std::uint32_t> blockOf,
                  std::uint64_t seed, int resamples) {
  OITLAB_CHECK_OP(samples.size(), ==, blockOf.size());
  OITLAB_CHECK_OP(resamples, >, 0);
  const Ranked ranked = rank(samples, blockOf);
  const std::vector<double>& sorted = ranked.values;
  Summary summary;
  summary.count = sorted.size();
  summary.notFinite = samples.size() - sorted.size();
  if (sorted.empty()) return summary;

  summary.min = sorted.front();
  summary.q1 = quantileOfSorted(sorted, 0.25);
  summary.median = quantileOfSorted(sorted, 0.5);
  summary.q3 = quantileOfSorted(sorted, 0.75);
  summary.p95 = quantileOfSorted(sorted, 0.95);
  summary.max = sorted.back();
  summary.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / double(sorted.size());
  summary.blocks = ranked.blockCount;
  if (summary.blocks < fewestBlocks) return summary;
  const std::vector<double> medians = bootstrapMedians(ranked, seed, resamples);
  summary.ci95 = {quantileOfSorted(medians, 0.025), quantileOfSorted(medians, 0.975)};
  return summary;
}

}  // namespace oitlab
