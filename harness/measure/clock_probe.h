#pragma once

#include "frame/frame.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// A fixed amount of arithmetic, timed by the device: the time is inversely proportional to the
/// clock of its cores. A submission of its own, never part of a frame.
class ClockProbe {
 public:
  /// Workgroups of 128 invocations, and turns of 32 dependent fma in each: 17 G fma in all. Fills
  /// the largest GPUs (270,000 invocations at once) four times over; by their peak rates 0.5 ms on
  /// 33 T fma/s at full clock.
  static constexpr std::uint32_t defaultGroups = 8192;
  static constexpr std::uint32_t defaultTurns = 512;

  /// `groups`, `turns`: at least 1, at most 65535. Throws DeviceError where the device refuses.
  explicit ClockProbe(const Device& device, std::uint32_t groups = defaultGroups,
                      std::uint32_t turns = defaultTurns);

  /// Halves the workgroups until a run takes at most 8 ms: six times the time of a large GPU at its
  /// lowest clock, so that these keep all, and slow devices do not spend seconds on it.
  void fit();

  /// Runs the work and waits for it. GPU time in milliseconds, or nothing where the timestamps were
  /// unusable. Throws DeviceError when the device fails.
  std::optional<double> run();

  std::uint32_t groups() const { return groups_; }

 private:
  const Device& device_;
  std::uint32_t groups_, turns_;
  MemoryLedger memory_;
  Pipeline pipeline_;
  Buffer result_;
  FrameTimer timer_;
  Commands commands_;
  vk::raii::Fence fence_;
};

}  // namespace oitlab
