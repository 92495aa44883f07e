#include "gpu/radix_sort.h"

#include "common/sort/sort_types.h"
#include "gpu/barrier.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab {
namespace {

/// What Vulkan guarantees for one dimension of a dispatch.
constexpr std::uint32_t maxGroups = 65535;

void computeBarrier(const Commands& commands) {
  memoryBarrier(commands, vk::PipelineStageFlagBits2::eComputeShader,
                vk::PipelineStageFlagBits2::eComputeShader);
}

}  // namespace

RadixSort::RadixSort(const Device& device, MemoryLedger& memory, std::uint32_t count)
    : count_(count),
      blocks_(divideUp(count, std::uint32_t(SORT_BLOCK))),
      countDigits_(Pipeline::compute(device, "common/sort/count.comp")),
      scan_(Pipeline::compute(device, "common/sort/scan.comp")),
      scatter_(Pipeline::compute(device, "common/sort/scatter.comp")) {
  if (blocks_ > maxGroups)
    fail<DeviceError>("a sort of {} elements: {} are the most", count,
                      std::uint64_t(maxGroups) * SORT_BLOCK);
  const std::uint64_t bytes = std::uint64_t(count) * sizeof(std::uint32_t);
  for (int i : {0, 1}) {
    keys_[std::size_t(i)] = Buffer(device, memory, "sort keys", bytes);
    values_[std::size_t(i)] = Buffer(device, memory, "sort values", bytes);
  }
  counts_ = Buffer(device, memory, "sort counts", blocks_ * SORT_DIGITS * sizeof(std::uint32_t));
  totals_ = Buffer(device, memory, "sort counts", SORT_DIGITS * sizeof(std::uint32_t));
}

void RadixSort::record(const Commands& commands) const {
  SortPush push{
      .counts = counts_.address(), .totals = totals_.address(), .count = count_, .blocks = blocks_};
  const auto step = [&](const Pipeline& pipeline, std::uint32_t groups) {
    pipeline.bind(commands, nullptr, push);
    commands.dispatch(groups, 1, 1);
    computeBarrier(commands);
  };
  // The number of passes is even, so the result is in the buffers that held the input.
  for (std::uint32_t pass = 0; pass < 32 / SORT_DIGIT_BITS; ++pass) {
    const std::size_t from = pass % 2, to = 1 - from;
    push.keysIn = keys_[from].address();
    push.valuesIn = values_[from].address();
    push.keysOut = keys_[to].address();
    push.valuesOut = values_[to].address();
    push.shift = pass * SORT_DIGIT_BITS;
    step(countDigits_, blocks_);
    step(scan_, SORT_DIGITS);
    step(scatter_, blocks_);
  }
}

}  // namespace oitlab
