#pragma once

#include <functional>

#include "gpu/shader.h"
#include "measure/clock_watch.h"
#include "measure/statistics.h"
#include "measure/stop_rule.h"
#include "render/renderer.h"

namespace oitlab {

struct MeasureSettings {
  StopRule::Limits stop;
  std::uint64_t seed = 1;  ///< of the order of the cells in each block
  int stageFrames = 10;    ///< frames of the separate run that times the stages

  /// A block lasts about this long on the GPU, within minFrames and maxFrames. Long enough that the
  /// clock's resolution does not matter, short enough that slow drift hits all cells alike.
  double blockSeconds = 0.05;
  int minFrames = 3;
  int maxFrames = 50;
};

/// GPU times in milliseconds with the block that each belongs to.
struct Series {
  std::vector<double> ms;
  std::vector<std::uint32_t> block;
  void add(double value, std::uint32_t inBlock) {
    ms.push_back(value);
    block.push_back(inBlock);
  }
};

/// How high the device's clock was while a configuration was measured, by the times of the probe
/// (measure/clock_watch.h), in milliseconds.
struct ClockRecord {
  double bestMs = 0;                 ///< the shortest level so far, of the whole run of the program
  double medianMs = 0;               ///< of the levels before the blocks that were kept
  std::uint32_t rejectedBlocks = 0;  ///< the clock moved while they were measured: not in `frame`
  std::uint32_t unsettledBlocks = 0;  ///< kept, and the clock was steady, but not the full one
  bool settled = false;               ///< all kept blocks and the stages were at full clock
};

/// Everything that was measured of one configuration.
struct Measurement {
  Series frame;                          ///< uninstrumented frames: the headline
  std::map<std::string, Series> stages;  ///< from a separate, instrumented run
  std::vector<std::string> stageOrder;   ///< stage names as recorded
  std::map<std::string, std::uint64_t> counters;
  std::vector<std::byte> image;  ///< the last timed frame, as the target stores it
  std::string stopReason;
  double relativeSpread = 0;
  double seconds = 0;                    ///< wall-clock time spent on this cell
  std::uint32_t blocks = 0;              ///< rejected ones included
  std::uint64_t rejectedSamples = 0;     ///< unusable timestamps, or frames recorded more than once
  std::optional<ClockRecord> clock;      ///< empty without a ClockWatch
  std::string failure;                   ///< not empty: it failed on the way, for this reason
  ShaderLibrary::Hashes shaders;         ///< that the method compiled while it was measured
  std::uint64_t validationMessages = 0;  ///< of the validation layers meanwhile, where they are on
};

/// How far a method is, while others are measured in turn with it.
struct MeasureProgress {
  std::uint32_t blocks = 0;
  double seconds = 0;  ///< wall-clock, of the blocks
  bool finished = false;
};

/// Measures methods against each other in shuffled blocks: in each block every method that still
/// wants samples has its turn, in random order, each with its own warm-up, so that a clock that
/// drifts does so for all. `done(i)` is called once for each method as soon as it is finished.
/// A method that fails leaves a Measurement with `failure`; the others go on.
///
/// With a `clock` each block begins at full clock; one at whose end the clock is another is
/// rejected, and counts towards the limits only. Without (null: CPU devices) nothing is known of
/// it. `afterBlock` gets the progress of all methods after each block.
///
/// Throws DeviceLost where the device stopped working: then nothing of what was not done() is
/// known. Throws Interrupted (util/interrupt.h).
void measureInterleaved(
    Renderer& renderer, const Camera& camera, const std::vector<Method*>& methods,
    const MeasureSettings& settings, ClockWatch* clock,
    const std::function<void(std::size_t, Measurement)>& done,
    const std::function<void(const std::vector<MeasureProgress>&)>& afterBlock = nullptr);

}  // namespace oitlab
