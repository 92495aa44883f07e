// The A-buffer's memory: it grows, counts what it may lose, and has only the buffers that it needs.
#include <gmock/gmock.h>

#include "abuffer/options.h"
#include "support/columns.h"

namespace oitlab::testing {
namespace {

TEST_F(Abuffer, GrowsAndLosesNothing) {
  RenderFixture fixture = columnFixture({30, 40, 50}, 8);
  const auto roomy = fixture.render("abuffer", {{"initial_depth", "64"}});
  const auto tight = fixture.render("abuffer", {{"initial_depth", "0"}});
  EXPECT_EQ(roomy.frame.recordings, 1);
  EXPECT_EQ(tight.frame.recordings, 2);
  EXPECT_EQ(tight.hash, roomy.hash);
  EXPECT_EQ(tight.frame.counters, roomy.frame.counters);
}

TEST_F(Abuffer, DropsWhatMemoryDoesNotHoldAndCountsIt) {
  constexpr unsigned pixels = 3 * 8, fragments = 8 * (30 + 40 + 50);
  RenderFixture fixture = columnFixture({30, 40, 50}, 8);
  for (const std::string& mask : masks)
    for (const std::string& memory : memories) {
      const Settings settings = {{"on_overflow", "drop"},
                                 {"initial_depth", "10"},
                                 {"mask", mask},
                                 {"sort_memory", memory},
                                 {"max_fragments", "16"}};
      const auto result = fixture.render("abuffer", settings);
      EXPECT_EQ(result.frame.counters.at("fragments"), fragments);
      EXPECT_EQ(result.frame.counters.at("blended_fragments"), 10 * pixels + 1) << nameOf(settings);
      EXPECT_EQ(result.frame.counters.at("lost_fragments"), fragments - 10 * pixels - 1);
    }
}

TEST_F(Abuffer, TruncatesAsThePaperDoesAndCountsIt) {
  RenderFixture fixture = columnFixture({10, 16, 17, 40, 300}, 2);
  for (const std::string& mask : masks)
    for (const std::string& memory : memories)
      for (const char* sort : {"auto", "register"}) {
        const Settings settings = {{"deep", "truncate"},
                                   {"max_fragments", "16"},
                                   {"mask", mask},
                                   {"sort_memory", memory},
                                   {"sort", sort}};
        const auto counters = fixture.render("abuffer", settings).frame.counters;
        EXPECT_EQ(counters.at("truncated_pixels"), 2u * 3) << nameOf(settings);
        EXPECT_EQ(counters.at("truncated_fragments"), 2u * (1 + 24 + 284)) << nameOf(settings);
        EXPECT_EQ(counters.at("blended_fragments"), 2u * (10 + 4 * 16)) << nameOf(settings);
      }
}

TEST_F(Abuffer, EachIntervalIsAStage) {
  RenderFixture fixture = columnFixture({10, 40});
  const auto stagesOf = [&](const Settings& settings) {
    std::vector<std::string> sortsRun;
    for (const auto& [name, ms] : fixture.render("abuffer", settings).frame.stageMs)
      if (name.rfind("sort", 0) == 0) sortsRun.push_back(name);
    return sortsRun;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(stagesOf({{"max_fragments", "32"}}), ElementsAre("sort 8", "sort 16", "sort 32"));
  EXPECT_THAT(stagesOf({{"sort_memory", "max_by_interval"}, {"max_fragments", "20"}}),
              ElementsAre("sort 8", "sort 16", "sort 20"));
  EXPECT_THAT(stagesOf({{"sort_memory", "max"}}), ElementsAre("sort"));
}

TEST_F(Abuffer, OnlyTheMaskInUseTakesMemory) {
  RenderFixture fixture(randomSoup(1, 8), 64, 32);
  const MethodInfo info = findMethod("abuffer");
  const auto buffersOf = [&](const Settings& settings) {
    const auto method =
        fixture.renderer().make(info, Parameters(info.parameters, settings, info.name));
    return method->memory().byName();
  };
  const auto bma = buffersOf({{"initial_depth", "2"}});
  EXPECT_EQ(bma.at("fragment nodes"), (2u * 64 * 32 + 1) * 28);
  EXPECT_EQ(bma.at("fragment counts"), 64u * 32 * 4);
  EXPECT_GE(bma.at("stencil"), 64u * 32);
  EXPECT_EQ(buffersOf({{"mask", "lists"}}).at("pixel lists"), 64u * 32 * 4);
  EXPECT_EQ(buffersOf({{"mask", "stencil_increment"}}).count("fragment counts"), 0u);
  const auto max = buffersOf({{"sort_memory", "max"}});
  EXPECT_EQ(max.count("fragment counts"), 0u);
  EXPECT_EQ(max.count("stencil"), 0u);
  EXPECT_EQ(buffersOf({{"node_color", "rgba8"}, {"initial_depth", "0"}}).at("fragment nodes"), 16u);
}

TEST(AbufferOptions, TellHowMuchLocalMemoryAnInvocationTakes) {
  const auto bytesOf = [](const Settings& settings) {
    const auto declared = abuffer::declareParameters();
    const abuffer::Options options(Parameters(declared, settings, "abuffer"), DeviceInfo{},
                                   "rgba32f");
    return options.intervals.back().localBytes;
  };
  EXPECT_EQ(bytesOf({{"sort", "insertion"}, {"max_fragments", "64"}}), 64u * 8);
  EXPECT_EQ(bytesOf({{"sort", "merge"}, {"max_fragments", "64"}}), (64u + 32) * 8);
  EXPECT_EQ(bytesOf({{"sort", "bitonic"}, {"max_fragments", "100"}}), 128u * 8);
  EXPECT_EQ(bytesOf({{"sort", "register"}, {"max_fragments", "512"}}), 16u * 8);
  EXPECT_EQ(bytesOf({{"max_fragments", "8"}}), 8u * 8);
  EXPECT_EQ(bytesOf({{"max_fragments", "8"}, {"sort_memory", "max"}}), 8u * 8);
  EXPECT_EQ(bytesOf({{"sort_memory", "max"}}), (512u + 256) * 8);
  EXPECT_EQ(bytesOf({{"local", "fragments"}}), (512u + 256) * 24);
  EXPECT_EQ(bytesOf({{"local", "fragments"}, {"node_color", "rgba8"}}), (512u + 256) * 12);
}

}  // namespace
}  // namespace oitlab::testing
