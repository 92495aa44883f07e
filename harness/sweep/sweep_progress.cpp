#include "sweep/sweep_progress.h"

#include <fmt/format.h>

namespace oitlab {
namespace {

std::size_t countCells(const std::vector<GroupSize>& groups) {
  std::size_t cells = 0;
  for (const GroupSize& group : groups) cells += group.cells;
  return cells;
}

}  // namespace

GroupSize sizeOf(const std::vector<CellSpec>& group) {
  return {group.size(), double(group.front().width) * group.front().height * 1e-6};
}

SweepProgress::SweepProgress(std::vector<GroupSize> groups, Pace& pace, bool enabled)
    : groups_(std::move(groups)), pace_(pace), line_(countCells(groups_), enabled) {}

void SweepProgress::begin(const std::vector<CellSpec>& group) {
  current_ = sizeOf(group);
  leaveOut(group);
  label_ = group.front().label();
  if (group.size() > 1) label_ += fmt::format(" (and {} against it)", group.size() - 1);
  progress_.clear();
  start_ = Clock::now();
  show();
}

void SweepProgress::measured(const std::vector<MeasureProgress>& progress) {
  progress_ = progress;
  show();
}

void SweepProgress::end(bool wasMeasured) {
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  if (wasMeasured) pace_.learn(current_, progress_, elapsed.count());
  done_ += current_.cells;
  line_.clear();
}

void SweepProgress::leaveOut(const std::vector<CellSpec>& group) {
  const GroupSize size = sizeOf(group);
  const auto same = std::find_if(groups_.begin(), groups_.end(), [&](const GroupSize& other) {
    return other.cells == size.cells && other.megapixels == size.megapixels;
  });
  if (same != groups_.end()) groups_.erase(same);
}

void SweepProgress::say(const std::string& line) {
  line_.clear();
  fmt::print(stderr, "{}\n", line);
}

void SweepProgress::show() {
  std::size_t finished = done_;
  std::uint32_t blocks = 0;
  for (const MeasureProgress& cell : progress_) {
    finished += cell.finished;
    blocks += cell.blocks;
  }
  const std::string label = blocks == 0 ? label_ : fmt::format("{}, block {}", label_, blocks);
  line_.show(finished, label, secondsLeft());
}

double SweepProgress::secondsLeft() const {
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  double seconds = pace_.secondsLeft(current_, progress_, elapsed.count());
  for (const GroupSize& group : groups_) seconds += pace_.secondsOf(group);
  return seconds;
}

}  // namespace oitlab
