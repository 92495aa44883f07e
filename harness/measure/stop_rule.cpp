#include "measure/stop_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/statistics.h"

namespace oitlab {
namespace {

std::vector<double> sortedCopy(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

void StopRule::addBlock(double blockMedian, double seconds) {
  ++blocks_;
  seconds_ += seconds;
  if (!std::isfinite(blockMedian)) return;
  blockMedians_.push_back(blockMedian);
  runningMedians_.push_back(quantileOfSorted(sortedCopy(blockMedians_), 0.5));
}

double StopRule::relativeSpread() const {
  if (blockMedians_.empty()) return std::numeric_limits<double>::infinity();
  const std::vector<double> sorted = sortedCopy(blockMedians_);
  const double median = quantileOfSorted(sorted, 0.5);
  const double range = quantileOfSorted(sorted, 0.75) - quantileOfSorted(sorted, 0.25);
  return median > 0 ? range / median : std::numeric_limits<double>::infinity();
}

bool StopRule::hasSettled() const {
  // One more than the window: the value before its first block is where the movement begins.
  const auto wanted = std::size_t(limits_.settleWindow) + 1;
  if (runningMedians_.size() < wanted) return false;
  const auto [low, high] =
      std::minmax_element(runningMedians_.end() - std::ptrdiff_t(wanted), runningMedians_.end());
  return *high - *low < limits_.relativeSpread * runningMedians_.back();
}

std::string StopRule::stopReason() const {
  // What says most about the answer comes first: a cell that is also out of time may still be good.
  if (blockMedians_.size() >= std::size_t(limits_.minBlocks)) {
    if (relativeSpread() < limits_.relativeSpread) return "spread";
    if (hasSettled()) return "settled";
  }
  if (seconds_ >= limits_.timeLimitSeconds) return "time_limit";
  if (blocks_ >= limits_.maxBlocks) return "max_blocks";
  return "";
}

}  // namespace oitlab
