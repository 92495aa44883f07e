#include "frame/frame_timer.h"

#include <algorithm>

#include "util/check.h"

namespace oitlab {
namespace {
constexpr std::uint32_t queryCount = 2 * (1 + FrameTimer::maxStages);
}

FrameTimer::FrameTimer(const Device& device)
    : device_(device), pool_(device.vk(), {{}, vk::QueryType::eTimestamp, queryCount}) {}

void FrameTimer::stamp(const Commands& commands) {
  OITLAB_CHECK_OP(next_, <, queryCount);
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, next_++);
}

void FrameTimer::begin(const Commands& commands, bool stages) {
  next_ = 0;
  stages_ = stages;
  names_.clear();
  commands.resetQueryPool(*pool_, 0, queryCount);
  stamp(commands);
}

void FrameTimer::end(const Commands& commands) {
  stamp(commands);
}

void FrameTimer::beginStage(const Commands& commands, const std::string& name) {
  OITLAB_CHECK(stages_);
  names_.push_back(name);
  stamp(commands);
}

void FrameTimer::endStage(const Commands& commands) {
  stamp(commands);
}

std::optional<std::uint64_t> FrameTimer::ticksBetween(std::uint64_t begin, std::uint64_t end,
                                                      std::uint32_t validBits) {
  const std::uint64_t mask = validBits >= 64 ? ~0ull : (1ull << validBits) - 1;
  const std::uint64_t ticks = (end - begin) & mask;
  if (ticks == 0 || ticks > mask / 2) return std::nullopt;
  return ticks;
}

FrameTimer::Reading FrameTimer::read() {
  const auto [result, stamps] = pool_.getResults<std::uint64_t>(
      0, next_, next_ * sizeof(std::uint64_t), sizeof(std::uint64_t),
      vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  OITLAB_CHECK(result == vk::Result::eSuccess);
  const double msPerTick = double(device_.info().timestampPeriodNs) * 1e-6;
  auto between = [&, &stamps = stamps](std::size_t first,
                                       std::size_t last) -> std::optional<double> {
    const auto ticks = ticksBetween(stamps[first], stamps[last], device_.info().timestampValidBits);
    if (!ticks) return std::nullopt;
    return double(*ticks) * msPerTick;
  };
  Reading reading;
  reading.frameMs = between(0, stamps.size() - 1);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    // A stage with nothing to do may take no ticks: it counts as 0, not as an error.
    const double ms = between(1 + 2 * i, 2 + 2 * i).value_or(0.0);
    auto same = std::find_if(reading.stageMs.begin(), reading.stageMs.end(),
                             [&](const auto& stage) { return stage.first == names_[i]; });
    if (same == reading.stageMs.end())
      reading.stageMs.emplace_back(names_[i], ms);
    else
      same->second += ms;
  }
  return reading;
}

}  // namespace oitlab
