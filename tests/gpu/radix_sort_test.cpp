// Compares the device's sort with std::stable_sort.
#include "gpu/radix_sort.h"

#include <numeric>

#include "gpu/barrier.h"
#include "support/gpu.h"
#include "util/random.h"

namespace oitlab::testing {
namespace {

class RadixSortGpu : public GpuTest {};

struct Sorted {
  std::vector<std::uint32_t> keys, values;
};

/// The device's result for `keys` with the values 0, 1, 2, ...
Sorted sortOnDevice(const std::vector<std::uint32_t>& keys) {
  const Device& device = sharedDevice();
  MemoryLedger memory;
  const RadixSort sort(device, memory, std::uint32_t(keys.size()));
  std::vector<std::uint32_t> values(keys.size());
  std::iota(values.begin(), values.end(), 0u);
  const Buffer givenKeys = uploadBuffer(device, memory, "keys", keys);
  const Buffer givenValues = uploadBuffer(device, memory, "values", values);
  const std::uint64_t bytes = keys.size() * sizeof(std::uint32_t);
  const Buffer keysBack(device, memory, "keys back", bytes, BufferKind::readback);
  const Buffer valuesBack(device, memory, "values back", bytes, BufferKind::readback);
  const vk::BufferCopy whole(0, 0, bytes);
  device.runOnce([&](const Commands& commands) {
    using Stage = vk::PipelineStageFlagBits2;
    const auto barrier = [&](vk::PipelineStageFlags2 from, vk::PipelineStageFlags2 to) {
      memoryBarrier(commands, from, to);
    };
    commands.copyBuffer(givenKeys.vk(), sort.keys().vk(), whole);
    commands.copyBuffer(givenValues.vk(), sort.values().vk(), whole);
    barrier(Stage::eTransfer, Stage::eComputeShader);
    sort.record(commands);
    barrier(Stage::eComputeShader, Stage::eTransfer);
    commands.copyBuffer(sort.keys().vk(), keysBack.vk(), whole);
    commands.copyBuffer(sort.values().vk(), valuesBack.vk(), whole);
    barrier(Stage::eTransfer, Stage::eHost);
  });
  const auto sortedKeys = keysBack.mapped<std::uint32_t>();
  const auto sortedValues = valuesBack.mapped<std::uint32_t>();
  return {{sortedKeys.begin(), sortedKeys.end()}, {sortedValues.begin(), sortedValues.end()}};
}

void expectSorted(const std::vector<std::uint32_t>& keys, const std::string& label) {
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  std::vector<std::uint32_t> inOrder;
  for (const std::uint32_t i : order) inOrder.push_back(keys[i]);
  const Sorted sorted = sortOnDevice(keys);
  EXPECT_TRUE(sorted.keys == inOrder) << label << ", " << keys.size() << " keys";
  EXPECT_TRUE(sorted.values == order) << label << ", " << keys.size() << " values";
}

// One element, part of a block, exactly a block, one more, and many.
TEST_F(RadixSortGpu, SortsAsTheStandardLibraryDoes) {
  Pcg32 random(5);
  for (const std::size_t count : {1, 2, 127, 2047, 2048, 2049, 70000}) {
    std::vector<std::uint32_t> keys(count);
    for (std::uint32_t& key : keys) key = random.next();
    expectSorted(keys, "any keys");
    for (std::uint32_t& key : keys) key %= 5;
    expectSorted(keys, "few keys, so that stability shows");
  }
  expectSorted(std::vector<std::uint32_t>(5000, ~0u), "one key");
}

// More blocks than a workgroup of the scan processes at once.
TEST_F(RadixSortGpu, SortsMillions) {
  Pcg32 random(6);
  std::vector<std::uint32_t> keys(2048 * 2048 + 12345);
  for (std::uint32_t& key : keys) key = random.next();
  expectSorted(keys, "any keys");
}

}  // namespace
}  // namespace oitlab::testing
