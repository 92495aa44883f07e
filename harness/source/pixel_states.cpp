#include "source/pixel_states.h"

#include "gpu/barrier.h"
#include "source/state_types.h"

namespace oitlab {
namespace {

using Stage = vk::PipelineStageFlagBits2;

/// Workgroups that add up: enough for a large GPU, few enough for a CPU.
constexpr std::uint32_t countingGroups = 256;

}  // namespace

PixelStates::PixelStates(const Device& device, const Target& target, MemoryLedger& memory)
    : device_(device), target_(target), memory_(memory) {}

void PixelStates::reserve(std::uint64_t bytes) {
  const std::uint64_t pixels = target_.pixels();
  if (empty()) {
    countTaken_ = Pipeline::compute(device_, "source/count_taken.comp");
    constants_ = Buffer(device_, memory_, "source constants", sizeof(PixelStateConstants),
                        BufferKind::upload);
    taken_ = Buffer(device_, memory_, "fragments taken", pixels * sizeof(std::uint32_t));
    sum_ = CountersBuffer(device_, memory_, "sum of fragments taken", sizeof(std::uint32_t));
  }
  if (pixels * bytes <= states_.bytes()) return;
  states_ = Buffer();
  states_ = Buffer(device_, memory_, "pixel states", pixels * bytes);
}

std::uint64_t PixelStates::begin(const Frame& frame) {
  constants_.mapped<PixelStateConstants>()[0] = {
      .frame = frame.values, .taken = taken_.address(), .states = states_.address()};
  return constants_.address();
}

void PixelStates::open(const Frame& frame) const {
  frame.barrier(Stage::eFragmentShader | Stage::eComputeShader, Stage::eTransfer);
  fillBuffer(frame.commands, taken_, 0);
  frame.barrier(Stage::eTransfer, Stage::eFragmentShader);
}

void PixelStates::count(const Frame& frame) {
  fillBuffer(frame.commands, sum_.buffer(), 0);
  frame.barrier(Stage::eTransfer, Stage::eComputeShader);
  frame.bind(countTaken_, CountTakenPush{.taken = taken_.address(),
                                         .sum = sum_.address(),
                                         .pixels = std::uint32_t(target_.pixels()),
                                         .invocations = countingGroups * COUNT_TAKEN_GROUP});
  frame.commands.dispatch(countingGroups, 1, 1);
  recordReadback(frame.commands, {&sum_});
  counted_ = true;
}

std::optional<std::uint64_t> PixelStates::taken() const {
  if (!counted_) return std::nullopt;
  return sum_.read<std::uint32_t>();
}

}  // namespace oitlab
