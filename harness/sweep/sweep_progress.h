#pragma once

#include "experiment/plan.h"
#include "sweep/pace.h"
#include "util/progress.h"

namespace oitlab {

/// The line that says how far a sweep is and how long it still takes, and where its messages go.
class SweepProgress {
 public:
  /// `groups`: those to be measured. `pace` must outlive this, and learns.
  SweepProgress(std::vector<GroupSize> groups, Pace& pace, bool enabled = isTerminal(stderr));

  void begin(const std::vector<CellSpec>& group);

  /// After each block of the group that was begun.
  void measured(const std::vector<MeasureProgress>& progress);

  /// The group is done; nothing is learned from one that was not measured.
  void end(bool wasMeasured);

  /// The group is not this run's to measure (another process has it, or it is there by now).
  void leaveOut(const std::vector<CellSpec>& group);

  /// A line for the user.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  void show();
  double secondsLeft() const;

  std::vector<GroupSize> groups_;  ///< not begun
  Pace& pace_;
  Progress line_;
  std::size_t done_ = 0;  ///< cells of groups that ended
  GroupSize current_;
  std::string label_;
  std::vector<MeasureProgress> progress_;
  Clock::time_point start_;
};

GroupSize sizeOf(const std::vector<CellSpec>& group);

}  // namespace oitlab
