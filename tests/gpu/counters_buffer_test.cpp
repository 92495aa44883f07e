// The CPU reads counters, whether or not it can map the device's memory.
#include "gpu/counters_buffer.h"

#include "gpu/barrier.h"
#include "gpu/zero_fill.h"
#include "support/gpu.h"

namespace oitlab::testing {
namespace {

class CountersBufferGpu : public GpuTest {};

TEST_F(CountersBufferGpu, IsReadMappedOrThroughACopy) {
  const Device& device = sharedDevice();
  const ZeroFill zeroFill(device);
  for (const bool mapped : {false, true}) {
    if (mapped && !device.canMapItsMemory()) continue;
    SCOPED_TRACE(mapped ? "mapped" : "through a copy");
    MemoryLedger memory;
    const CountersBuffer counters(device, memory, "counters", 4 * sizeof(std::uint32_t), mapped);
    EXPECT_EQ(memory.byName().size(), mapped ? 1u : 2u);
    using Stage = vk::PipelineStageFlagBits2;
    device.runOnce([&](const Commands& commands) {
      fillBuffer(commands, counters.buffer(), 7);
      memoryBarrier(commands, Stage::eTransfer, Stage::eComputeShader);
      recordReadback(commands, {&counters});
    });
    EXPECT_EQ(counters.read<std::uint32_t>(), 7u);
    // A compute shader writes them, as in a frame.
    device.runOnce([&](const Commands& commands) {
      const Buffer* const buffers[] = {&counters.buffer()};
      zeroFill.record(commands, buffers);
      recordReadback(commands, {&counters});
    });
    EXPECT_EQ(counters.read<std::uint32_t>(), 0u);
  }
}

}  // namespace
}  // namespace oitlab::testing
