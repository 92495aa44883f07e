#pragma once

#include <functional>
#include <limits>
#include <optional>

namespace oitlab {

/// Judges a GPU's clock by the times of one fixed piece of work (the probe), which are inversely
/// proportional to it. A GPU that idles for some tens of milliseconds lowers its clock several
/// times over, and raises it only under load: what is measured meanwhile is not the method.
class ClockWatch {
 public:
  struct Limits {
    double tolerance = 0.03;  ///< settled: within so much of the fastest; probes repeat to under 1%
    double blockTolerance = 0.05;  ///< a block between whose ends the clock moves by more is void
    double firstSeconds = 0.5;     ///< of load before the very first judgement: nothing to compare
    double loadSeconds = 0.05;     ///< of load after idling, and after the last gain in clock
    double idleSeconds = 0.005;    ///< longer without a probe counts as idle
    double limitSeconds = 1;       ///< then it goes on, settled or not
  };

  /// Runs the work once: its GPU time in milliseconds, or nothing where the timestamps were
  /// unusable.
  using Probe = std::function<std::optional<double>()>;
  /// Seconds since some fixed moment.
  using Now = std::function<double()>;

  ClockWatch(Probe probe, Limits limits, Now now);
  /// With the default limits, on the steady clock.
  explicit ClockWatch(Probe probe);

  /// Probes until the clock is as high as this device gets it, and rises no more; right before what
  /// is measured. Returns the level, the median time of the last probes in milliseconds: the
  /// caller holds it against bestMs() by isFull(). Where the limit passes first (a GPU that
  /// throttles, or that others use), the level reached is what later calls wait for, until it is
  /// better again. NaN without a usable probe.
  double settle();

  /// Right after what was measured: whether the clock is still that of the last settle(), within
  /// `blockTolerance` either way.
  bool held();

  /// The shortest level so far, of the program's whole run; infinite before the first.
  double bestMs() const { return best_; }

  /// Whether a level of settle() is within `tolerance` of the best so far.
  bool isFull(double levelMs) const { return levelMs <= best_ * (1 + limits_.tolerance); }

  const Limits& limits() const { return limits_; }

 private:
  std::optional<double> runProbe();

  Probe probe_;
  Limits limits_;
  Now now_;
  double level_ = std::numeric_limits<double>::quiet_NaN();  ///< of the last settle()
  double best_ = std::numeric_limits<double>::infinity();
  double target_ = std::numeric_limits<double>::infinity();  ///< what settle() waits for
  double lastProbe_ = -std::numeric_limits<double>::infinity();
};

}  // namespace oitlab
