#pragma once

#include "frame/frame.h"

namespace oitlab {

/// Counts the fragments that pass the depth test and are not discarded, for methods that do not
/// count fragments themselves. It is a precise occlusion query. Because a query may cost time, only
/// instrumented frames have one. A device without occlusionQueryPrecise gives no count.
class SampleCounter {
 public:
  explicit SampleCounter(const Device& device) {
    if (device.info().has("occlusionQueryPrecise"))
      query_ = vk::raii::QueryPool(device.vk(), {{}, vk::QueryType::eOcclusion, 1});
  }

  /// Call it before the render pass whose fragments are counted.
  void reset(const Frame& frame) {
    active_ = frame.instrumented && *query_;
    counted_ = false;
    if (active_) frame.commands.resetQueryPool(*query_, 0, 1);
  }

  /// Call it within the render pass; `draw` records the draws.
  template <typename Draw>
  void count(const Frame& frame, Draw&& draw) {
    counted_ = active_;
    if (active_) frame.commands.beginQuery(*query_, 0, vk::QueryControlFlagBits::ePrecise);
    draw();
    if (active_) frame.commands.endQuery(*query_, 0);
  }

  /// {"fragments": N} of the last instrumented frame, once the device has finished it. Empty before
  /// the first, and where nothing was counted.
  const std::map<std::string, std::uint64_t>& counters() {
    if (counted_) {  // a query that has not begun has no result, and some drivers wait for it
      const auto [result, samples] = query_.getResult<std::uint64_t>(
          0, 1, sizeof(std::uint64_t),
          vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
      if (result == vk::Result::eSuccess) counters_["fragments"] = samples;
    }
    return counters_;
  }

 private:
  bool active_ = false, counted_ = false;
  vk::raii::QueryPool query_ = nullptr;
  std::map<std::string, std::uint64_t> counters_;
};

}  // namespace oitlab
