// How much local memory a shader can have: the experiment with it, and what depends on it.
#include <gmock/gmock.h>

#include "support/columns.h"
#include "util/error.h"

namespace oitlab::testing {
namespace {

using ::testing::HasSubstr;

class LocalMemory : public GpuTest {};

/// A camera that sees nothing.
Camera away() {
  Camera camera = frontCamera();
  camera.eye = {0, 0, 5};
  camera.target = {0, 0, 6};
  return camera;
}

// The experiment of figure 3 draws nothing, for every length of its array up to the 8 KiB of the
// experiment.
TEST_F(LocalMemory, LeavesTheImageAsItWas) {
  RenderFixture fixture(randomSoup(1, 8), 33, 9);
  const std::string background = fixture.render("reference", {}, away()).hash;
  for (const char* size : {"1", "64", "512"}) {
    const auto result = fixture.render("local_memory", {{"size", size}, {"passes", "3"}}, away());
    EXPECT_EQ(result.hash, background) << size;
    EXPECT_EQ(result.frame.stageMs.back().first, "fill");
  }
}

// Drivers may refuse longer arrays: NVIDIA's 580.159.04 does so at 16 KiB per invocation, with an
// error that names no shader. Then the program says which shader it was and what to change.
TEST_F(LocalMemory, MuchOfItWorksOrIsRefusedWithAReason) {
  RenderFixture fixture(randomSoup(1, 8), 33, 9);
  const std::string background = fixture.render("reference", {}, away()).hash;
  const std::string exact = fixture.render("reference").hash;
  std::vector<std::string> refusals;
  const auto refusedOr = [&](const std::string& hash, const std::string& method,
                             const Settings& settings, const Camera& camera,
                             std::vector<std::string> said) {
    try {
      EXPECT_EQ(fixture.render(method, settings, camera).hash, hash) << nameOf(settings);
    } catch (const DeviceError& error) {
      for (const std::string& part : said) EXPECT_THAT(error.what(), HasSubstr(part));
      refusals.emplace_back(error.what());
    }
  };
  refusedOr(background, "local_memory", {{"size", "1024"}, {"passes", "3"}}, away(),
            {"local_memory.frag", "SIZE=1024", "16384 bytes", "lower 'size'"});
  // There is one pipeline per interval of lengths, and the refused one need not be the longest.
  refusedOr(exact, "abuffer", {{"local", "fragments"}, {"max_fragments", "1024"}},
            fixture.defaultView(),
            {"abuffer/resolve.frag", "MAX_FRAGMENTS=", " bytes of local memory",
             "lower 'max_fragments' (now 1024)", "local=keys"});
  if (!refusals.empty() && !HasFailure())
    GTEST_SKIP() << fmt::format("{}", fmt::join(refusals, "\n"));
}

}  // namespace
}  // namespace oitlab::testing
