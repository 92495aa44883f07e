// Exclusive programs with source=hardware: fragment shader interlock, and states in memory.
//
// lavapipe has no interlock, but needs none: llvmpipe runs all fragment shaders of a pixel on one
// thread, in the order of submission. There the tests leave the interlock out, and test the rest.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <glslang/SPIRV/spirv.hpp>

#include "gpu/struct_size.h"
#include "method/make_source.h"
#include "method/one_pass_method.h"
#include "quality/compare.h"
#include "source/state_size.h"
#include "support/environment.h"
#include "support/planted.h"
#include "support/sources.h"
#include "util/error.h"

namespace oitlab::testing {
namespace {

// Programs are named relative to shaders/.
FragmentProgram nearestLayers(int kept) {
  return {.file = "../tests/data/toy/shaders/nearest_layers/nearest.glsl",
          .access = Access::exclusive,
          .defines = {{"KEPT", std::to_string(kept)}}};
}
FragmentProgram over() {
  return {.file = "../tests/data/programs/over.glsl", .access = Access::exclusive};
}

class OneProgram : public OnePassMethod {
 public:
  OneProgram(const MethodContext& context, const FragmentProgram& program)
      : OnePassMethod(context, program) {}
  void record(const Frame& frame) override { recordPass(frame, "pass", FrameOnly{}); }
};

std::unique_ptr<Method> makeOne(RenderFixture& fixture, const FragmentProgram& program,
                                const Given& given = {}) {
  const MethodInfo info{
      .name = "one_program",
      .summary = {},
      .source = {},
      .exact = false,
      .parameters = sourceParameters(),
      .features = {},
      .takesFragments = true,
      .make = [&](const MethodContext& c) { return std::make_unique<OneProgram>(c, program); }};
  return info.makeFor(sharedDevice(), fixture.renderer().scene(), fixture.target(),
                      Parameters(info.parameters, given, info.name));
}

RenderFixture::Result renderOne(RenderFixture& fixture, const FragmentProgram& program,
                                const Given& given = {}) {
  return fixture.render(*makeOne(fixture, program, given), fixture.defaultView());
}

class ExclusiveFromHardware : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped()) return;
    const DeviceInfo& info = sharedDevice().info();
    if (info.has("fragmentShaderPixelInterlock")) return;
    if (info.driver != "llvmpipe") GTEST_SKIP() << info.name << " lacks fragment shader interlock";
    withoutInterlock_.emplace("OITLAB_WITHOUT_INTERLOCK", "1");
  }

 private:
  std::optional<ScopedEnvironment> withoutInterlock_;
};

// As the other programs: see Sources.HardwareAndComputeDifferOnlyAtEdges.
TEST_F(ExclusiveFromHardware, NearestLayersDifferFromComputeOnlyAtEdges) {
  for (const Scene& scene : variedScenes()) {
    RenderFixture fixture(scene, 160, 90);
    const CpuImage truth = renderOnCpu(scene, findView(scene, "default"), 160, 90);
    const std::vector<int> sizes = scene.name == "planes" ? std::vector{1, 4, 8} : std::vector{4};
    for (const int kept : sizes)
      expectEqualButAtEdges(
          renderOne(fixture, nearestLayers(kept)),
          renderOne(fixture, nearestLayers(kept), onCompute({{"deliver", "submission"}})), truth,
          fmt::format("{} {}", scene.name, kept));
  }
}

// The same fragments, from the same rasterizer, blended by the ROPs in the order of submission. A
// fragment that got lost, came twice or too early would show.
TEST_F(ExclusiveFromHardware, FragmentsComeOnceAndInTheOrderOfSubmission) {
  std::vector<Scene> scenes = {loadScene({"planes", {}, 1.0f}), loadScene({"scrubpine", {}, 0.3f}),
                               layers(200, 0.0f, 0.0f, 0.05f), stack(500, 0.01f)};
  for (const Scene& scene : scenes)
    for (const std::optional<std::uint64_t> shuffle : {std::optional<std::uint64_t>(), {4}}) {
      RenderFixture fixture(scene, 161, 91, shuffle);
      const auto blended = fixture.render("blend");
      const auto exclusive = renderOne(fixture, over());
      // Float32 rounds each of up to 500 layers, in another way than blending units do.
      EXPECT_LT(compareImages(exclusive.image, blended.image).maxError, 1e-4) << scene.name;
      EXPECT_EQ(exclusive.frame.counters.at("fragments"), blended.frame.counters.at("fragments"));
    }
}

TEST_F(ExclusiveFromHardware, FramesDependOnNothingOld) {
  const Scene scene = loadScene({"boxes", {}, 0.3f});
  RenderFixture fixture(scene, 130, 70);
  const Camera other = parseCamera("orbit:0.3,0.2,0.4,90", scene.bounds);
  const auto method = makeOne(fixture, nearestLayers(4));
  const std::string hash = fixture.render(*method, fixture.defaultView()).hash;
  const std::string otherHash = fixture.render(*method, other).hash;
  EXPECT_NE(hash, otherHash);
  EXPECT_EQ(fixture.render(*method, fixture.defaultView()).hash, hash);
  EXPECT_EQ(fixture.render(*makeOne(fixture, nearestLayers(4)), other).hash, otherHash);
}

TEST_F(ExclusiveFromHardware, StatesAreListedAndCounted) {
  RenderFixture nothing(triangleScene({}, {{1, 1, 1, 1}}, frontCamera()), 33, 7);
  const auto empty = renderOne(nothing, nearestLayers(2));
  EXPECT_EQ(empty.hash, nothing.render("blend").hash);
  EXPECT_EQ(empty.frame.counters.at("fragments"), 0u);
  EXPECT_EQ(empty.memory.at("method: pixel states"), 33u * 7 * 2 * 24);
}

TEST_F(ExclusiveFromHardware, OtherOrdersAreRefused) {
  RenderFixture fixture(randomSoup(1, 5), 8, 8);
  EXPECT_THROW(renderOne(fixture, over(), {{"deliver", "near_to_far"}}), InputError);
}

class Exclusive : public GpuTest {};

TEST_F(Exclusive, WithoutInterlockOneLineSaysWhyNot) {
  if (sharedDevice().info().has("fragmentShaderPixelInterlock"))
    GTEST_SKIP() << "the device has fragmentShaderPixelInterlock";
  RenderFixture fixture(randomSoup(1, 5), 8, 8);
  try {
    makeOne(fixture, over());
    FAIL() << "it was made";
  } catch (const DeviceError& error) {
    EXPECT_EQ(std::string(error.what()),
              "source=hardware needs fragmentShaderPixelInterlock, which " +
                  sharedDevice().info().name +
                  " lacks, to give a pixel to one fragment at a time; source=compute does without");
  }
}

Defines definesForHardware(const FragmentProgram& program) {
  Defines defines = program.defines;
  defines.insert({{"FRAGMENT_PROGRAM", program.file},
                  {"ACCESS", std::to_string(ACCESS_EXCLUSIVE)},
                  {"HAS_ID", "1"},
                  {"INTERLOCK", "1"}});
  return defines;
}

// 21 layers of 24 bytes are 504 bytes, the largest state is 512.
TEST_F(Exclusive, AStateTooLargeForRegistersIsRefusedInOneLine) {
  const auto sizeOf = [](const FragmentProgram& program) {
    return stateBytes(sharedDevice(), program, "source/hardware.frag", definesForHardware(program));
  };
  EXPECT_EQ(sizeOf(nearestLayers(21)), 504u);
  EXPECT_THROW(sizeOf(nearestLayers(22)), DeviceError);

  RenderFixture fixture(randomSoup(1, 5), 8, 8);
  const ScopedEnvironment withoutInterlock("OITLAB_WITHOUT_INTERLOCK", "1");
  for (const Given& given : {Given{}, onCompute()}) {
    try {
      makeOne(fixture, nearestLayers(22), given);
      ADD_FAILURE() << "it was made";
    } catch (const DeviceError& error) {
      EXPECT_EQ(std::string(error.what()),
                "shaders/../tests/data/toy/shaders/nearest_layers/nearest.glsl: PixelState has 528 "
                "bytes, 132 registers of 32 bits; at most 128 fit beside the source's own "
                "(NVIDIA's GPUs give an invocation 255, AMD's 256; Vulkan does not tell). Keep "
                "less per pixel, or access=none with buffers of your own");
    }
  }
}

/// The instruction `op` whose operand `index` is `value`, as its operands; empty if there is none.
std::vector<std::uint32_t> instruction(const std::vector<std::uint32_t>& words, spv::Op op,
                                       std::size_t index, std::uint32_t value) {
  for (std::size_t at = 5; at < words.size(); at += words[at] >> spv::WordCountShift) {
    const std::size_t length = words[at] >> spv::WordCountShift;
    if ((words[at] & spv::OpCodeMask) == op && index + 1 < length && words[at + 1 + index] == value)
      return {words.begin() + long(at) + 1, words.begin() + long(at + length)};
  }
  return {};
}

std::vector<std::uint32_t> compileForHardware(const FragmentProgram& program) {
  return sharedDevice().shaders().compile("source/hardware.frag", definesForHardware(program));
}

// Also on devices that cannot make a pipeline of it.
TEST_F(Exclusive, TheShaderHasACriticalSectionInOrder) {
  for (const FragmentProgram& program : {nearestLayers(1), nearestLayers(8), over()}) {
    const auto words = compileForHardware(program);
    const auto has = [&](spv::Op op, std::size_t index, std::uint32_t value) {
      return !instruction(words, op, index, value).empty();
    };
    EXPECT_TRUE(has(spv::OpCapability, 0, spv::CapabilityFragmentShaderPixelInterlockEXT));
    EXPECT_TRUE(has(spv::OpExecutionMode, 1, spv::ExecutionModePixelInterlockOrderedEXT));
    EXPECT_TRUE(has(spv::OpExecutionMode, 1, spv::ExecutionModeEarlyFragmentTests));
  }
}

TEST_F(Exclusive, TheSizeOfAStateIsThatOfTheShader) {
  const std::map<std::string, std::uint64_t> expected = {
      {nearestLayers(4).file, 4 * 24},
      {over().file, 16},
      // first, key, flags, three, matrix, inner, address, last; the alignment is 8
      {"../tests/data/programs/every_type.glsl",
       (4 + 4) + 8 + 12 + 12 + 48 + 2 * 16 + 8 + (4 + 4)}};
  for (const auto& [file, bytes] : expected) {
    const auto words =
        compileForHardware({.file = file, .access = Access::exclusive, .defines = {{"KEPT", "4"}}});
    EXPECT_EQ(structBytes(words, "PixelState"), bytes) << file;
    // The stride of the states in memory is the only other place that has the number.
    bool found = false;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> spv::WordCountShift)
      if ((words[at] & spv::OpCodeMask) == spv::OpDecorate &&
          words[at + 2] == spv::DecorationArrayStride && words[at + 3] == bytes)
        found |= !instruction(words, spv::OpTypeRuntimeArray, 0, words[at + 1]).empty();
    EXPECT_TRUE(found) << file;
  }
  EXPECT_THROW(structBytes(compileForHardware(over()), "PixelStat"), InputError);
}

}  // namespace
}  // namespace oitlab::testing
