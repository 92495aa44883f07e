#pragma once

#include <string>
#include <vector>

namespace oitlab {

/// When a cell has been measured well enough (design: "Measuring").
class StopRule {
 public:
  struct Limits {
    double relativeSpread = 0.005;  ///< "spread": below it the cell is done
    int minBlocks = 10;  ///< never judged on fewer: a bootstrap over blocks wants some to draw from
    int settleWindow = 5;          ///< "settled": blocks over which the median stood still
    double timeLimitSeconds = 10;  ///< "time_limit": wall-clock time spent on this cell
    int maxBlocks = 200;           ///< "max_blocks"
  };
  explicit StopRule(Limits limits) : limits_(limits) {}

  /// Adds the median of one finished block and the wall-clock seconds that the block took. A block
  /// without a usable frame (NaN) counts towards the limits only, lest the cell never ends.
  void addBlock(double blockMedian, double seconds);

  /// Interquartile range of the block medians over their median; infinity while there is none, or
  /// where the median is not positive.
  double relativeSpread() const;

  /// "" while more blocks are wanted, else "spread", "settled", "time_limit" or "max_blocks".
  /// Settled: over the last `settleWindow` blocks the running median moved by less than
  /// `relativeSpread` in all, so that more blocks of the same noise would not change the answer.
  /// The time limit and `maxBlocks` hold from the first block on, `minBlocks` or not.
  std::string stopReason() const;

 private:
  bool hasSettled() const;

  Limits limits_;
  int blocks_ = 0;
  std::vector<double> blockMedians_;
  std::vector<double> runningMedians_;
  double seconds_ = 0;
};

}  // namespace oitlab
