#include "measure/clock_watch.h"

#include "measure/statistics.h"

namespace oitlab {
namespace {

/// Probes that make a level: by the median, so that one that was disturbed changes nothing, and no
/// single time that is too short is waited for ever after.
constexpr std::size_t levelProbes = 5;
constexpr std::size_t heldProbes = 3;

/// A level that is shorter than the best by less is noise, not a clock that rises.
constexpr double gain = 0.01;

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantileOfSorted(values, 0.5);
}

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

ClockWatch::ClockWatch(Probe probe, Limits limits, Now now)
    : probe_(std::move(probe)), limits_(limits), now_(std::move(now)) {}

ClockWatch::ClockWatch(Probe probe) : ClockWatch(std::move(probe), Limits(), steadySeconds) {}

std::optional<double> ClockWatch::runProbe() {
  const auto ms = probe_();
  lastProbe_ = now_();
  return ms;
}

double ClockWatch::settle() {
  const double begin = now_();
  double until = begin;  // it goes on at least so long
  if (!std::isfinite(best_))
    until += limits_.firstSeconds;
  else if (begin - lastProbe_ > limits_.idleSeconds)
    until += limits_.loadSeconds;

  level_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> last;
  for (;;) {
    if (const auto ms = runProbe()) last.push_back(*ms);
    if (last.size() > levelProbes) last.erase(last.begin());
    if (last.size() == levelProbes) {
      level_ = medianOf(last);
      if (level_ < target_ * (1 - gain)) until = std::max(until, lastProbe_ + limits_.loadSeconds);
      target_ = std::min(target_, level_);
      best_ = std::min(best_, level_);
      if (lastProbe_ >= until && level_ <= target_ * (1 + limits_.tolerance)) return level_;
    }
    if (lastProbe_ - begin < limits_.limitSeconds) continue;
    if (last.empty()) return level_;
    level_ = medianOf(last);  // also of fewer probes, where each takes long
    best_ = std::min(best_, level_);
    return target_ = level_;
  }
}

bool ClockWatch::held() {
  std::vector<double> times;
  for (std::size_t i = 0; i < heldProbes; ++i)
    if (const auto ms = runProbe()) times.push_back(*ms);
  if (times.empty() || !std::isfinite(level_)) return false;
  const double ratio = medianOf(times) / level_;
  return std::max(ratio, 1 / ratio) <= 1 + limits_.blockTolerance;
}

}  // namespace oitlab
