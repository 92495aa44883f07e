#include "measure/clock_probe.h"

#include "gpu/barrier.h"
#include "measure/clock_probe_types.h"
#include "util/check.h"
#include "util/error.h"

namespace oitlab {
namespace {

/// Parts the work from the stamp before it and the one behind: lavapipe (Mesa 22.3) takes
/// timestamps no earlier than it must, and without this both after a dispatch between them.
void waitForAll(const Commands& commands) {
  memoryBarrier(commands, vk::PipelineStageFlagBits2::eAllCommands,
                vk::PipelineStageFlagBits2::eAllCommands);
}

}  // namespace

ClockProbe::ClockProbe(const Device& device, std::uint32_t groups, std::uint32_t turns)
    : device_(device),
      groups_(groups),
      turns_(turns),
      pipeline_(Pipeline::compute(device, "measure/clock_probe.comp")),
      result_(device, memory_, "clock probe", sizeof(float)),
      timer_(device),
      commands_(device.makeCommandBuffer()),
      fence_(device.vk(), vk::FenceCreateInfo()) {
  OITLAB_CHECK(groups >= 1 && groups <= 65535 && turns >= 1 && turns <= 65535);
}

void ClockProbe::fit() {
  constexpr double mostMs = 8;
  run();  // the first also pays for what drivers do late
  while (groups_ > 1 && run().value_or(0) > mostMs) groups_ /= 2;
}

std::optional<double> ClockProbe::run() {
  try {
    commands_.reset();
    commands_.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    timer_.begin(commands_, false);
    waitForAll(commands_);
    // From [0, 1) towards 1: no value is large, none denormal.
    pipeline_.bind(commands_, nullptr,
                   ClockProbePush{.result = result_.address(),
                                  .iterations = turns_,
                                  .factor = 0.999f,
                                  .summand = 0.001f,
                                  .threshold = 2.0f});
    commands_.dispatch(groups_, 1, 1);
    waitForAll(commands_);
    timer_.end(commands_);
    commands_.end();
    device_.vk().resetFences(*fence_);
    device_.submit(commands_, *fence_);
    device_.wait(*fence_);
    return timer_.read().frameMs;
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("{} failed while its clock was probed: {}", device_.info().name,
                      error.what());
  }
}

}  // namespace oitlab
