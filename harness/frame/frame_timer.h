#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace oitlab {

/// GPU timestamps of one frame: at its start and end and, if asked for, at the start and end of
/// each stage. One frame is in flight at a time.
class FrameTimer {
 public:
  static constexpr std::uint32_t maxStages = 32;

  explicit FrameTimer(const Device& device);

  struct Reading {
    std::optional<double>
        frameMs;  ///< empty when the difference was zero or negative: a rejected sample
    std::vector<std::pair<std::string, double>>
        stageMs;  ///< in recording order; stages of the same name are summed
  };

  void begin(const Commands& commands, bool stages);
  void end(const Commands& commands);
  void beginStage(const Commands& commands, const std::string& name);
  void endStage(const Commands& commands);

  /// Call it once the device has finished the frame.
  Reading read();

  /// Ticks between two raw timestamps, of which only the low `validBits` are valid. Empty when the
  /// difference is zero, or more than half the counter's range, which means that time went
  /// backwards.
  static std::optional<std::uint64_t> ticksBetween(std::uint64_t begin, std::uint64_t end,
                                                   std::uint32_t validBits);

 private:
  void stamp(const Commands& commands);

  const Device& device_;
  vk::raii::QueryPool pool_;
  std::uint32_t next_ = 0;
  bool stages_ = false;
  std::vector<std::string> names_;
};

}  // namespace oitlab
