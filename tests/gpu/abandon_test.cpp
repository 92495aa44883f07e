// A device that does not finish in time counts as lost, and its objects may be dropped.
#include <gmock/gmock.h>

#include "gpu/buffer.h"
#include "support/gpu.h"
#include "util/error.h"

namespace oitlab::testing {
namespace {

class Abandon : public GpuTest {};

TEST_F(Abandon, ADeviceThatDoesNotFinishIsLostAndKeepsWhatItUses) {
  const Device device(Device::Options{.validation = true});
  {
    MemoryLedger ledger;
    const Buffer buffer(device, ledger, "a buffer of the test", 64);
    const Commands commands = device.makeCommandBuffer();
    commands.begin(vk::CommandBufferBeginInfo());
    commands.fillBuffer(buffer.vk(), 0, 64, 1);
    commands.end();
    const vk::raii::Fence never(device.vk(), vk::FenceCreateInfo());
    device.submit(commands, {});  // nobody waits for it: the layer takes the buffer to be in use
    EXPECT_THROW(device.wait(*never, 0.001), DeviceHung);
    EXPECT_TRUE(device.isLost());
    EXPECT_THROW(device.submit(commands, {}), vk::DeviceLostError);
    EXPECT_THROW(device.wait(*never, 0.001), DeviceLost);
  }
  EXPECT_THAT(device.validationMessages(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace oitlab::testing
