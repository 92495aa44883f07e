// What the validation layer is told: names of objects, and what shaders print.
#include "gpu/debug_names.h"

#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "support/environment.h"
#include "support/gpu.h"
#include "util/text_file.h"

namespace oitlab::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class DebugNames : public GpuTest {};

TEST_F(DebugNames, AMessageOfTheLayerHasTheNameOfTheLedger) {
  ::testing::internal::CaptureStderr();  // the message is meant
  const Device device(Device::Options{.validation = true});
  EXPECT_TRUE(device.showsNames());
  MemoryLedger ledger;
  const Buffer buffer(device, ledger, "a buffer of the test", 64);
  const Commands commands = device.makeCommandBuffer();  // not submitted
  commands.begin(vk::CommandBufferBeginInfo());
  {
    const DebugLabel label(device, commands, "a stage of the test");
    commands.copyBuffer(buffer.vk(), buffer.vk(), vk::BufferCopy(0, 1 << 20, 4));  // beyond its end
  }
  commands.end();
  ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(device.validationMessages(), Contains(HasSubstr("a buffer of the test")));
}

TEST_F(DebugNames, WithoutValidationOrAToolThereAreNone) {
  EXPECT_FALSE(Device(Device::Options{}).showsNames());
  const ScopedEnvironment wanted("OITLAB_DEBUG_NAMES", "1");
  EXPECT_TRUE(Device(Device::Options{}).showsNames());
}

/// With a root folder of its own, where the test puts its shader.
class ShaderPrintf : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();  // finds its shaders before the root changes
    folder_ =
        std::filesystem::temp_directory_path() / fmt::format("oitlab_ShaderPrintf_{}", getpid());
    std::filesystem::create_directories(folder_ / "shaders");
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    GpuTest::TearDown();
  }
  std::filesystem::path folder_;
};

TEST_F(ShaderPrintf, PrintsToStderrAndIsNoMessageOfValidation) {
  writeFileAtomically(folder_ / "shaders" / "print.comp",
                      "layout(local_size_x = 1) in;\n"
                      "layout(push_constant, scalar) uniform Push { uint number; };\n"
                      "void main() { debugPrintfEXT(\"number %u\", number); }\n");
  const ScopedEnvironment root("OITLAB_ROOT", folder_.string());
  ::testing::internal::CaptureStderr();
  const Device device(Device::Options{.shaderPrintf = true});
  const Pipeline pipeline = Pipeline::compute(device, "print.comp");
  std::string expected;
  for (std::uint32_t number = 4711; number < 4719; ++number) {  // text must not be lost by chance
    device.runOnce([&](const Commands& commands) {
      pipeline.bind(commands, nullptr, number);
      commands.dispatch(1, 1, 1);
    });
    expected += fmt::format("shader: number {}\n", number);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), expected);
  EXPECT_TRUE(device.validation());
  EXPECT_THAT(device.validationMessages(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace oitlab::testing
