// Measuring in blocks on a device whose clock changes, and the clock probe. The clock is simulated,
// because the program cannot change that of a CPU device.
#include "measure/measure.h"

#include <gmock/gmock.h>

#include "measure/clock_probe.h"
#include "support/gpu.h"

namespace oitlab::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int framesBefore = 2;   // those of prepareSubject()
constexpr int framesOfBlock = 4;  // including one to warm up
constexpr int blockCount = 6;

MeasureSettings smallSettings() {
  MeasureSettings settings;
  settings.stop.relativeSpread = 0;  // never reached: measuring ends at maxBlocks
  settings.stop.maxBlocks = blockCount;
  settings.stop.timeLimitSeconds = 600;
  settings.minFrames = settings.maxFrames = framesOfBlock - 1;
  settings.stageFrames = 2;
  return settings;
}

/// The probe's times on a simulated device, in simulated seconds.
struct MadeUpClock {
  double ms = 1;
  int slowProbes = 0;  ///< this many of the next probes take half as long again
  double now = 0;
  ClockWatch watch{[this]() -> std::optional<double> {
                     now += 0.01;
                     return slowProbes > 0 ? (--slowProbes, 1.5 * ms) : ms;
                   },
                   {},
                   [this] { return now; }};
};

constexpr int stages = -1;

/// Draws nothing, and calls `tell` at the end of each block and of each frame with stages.
class BlockTeller : public Method {
 public:
  explicit BlockTeller(std::function<void(int block)> tell) : tell_(std::move(tell)) {}
  void record(const Frame& frame) override {
    if (frame.instrumented) {
      frame.stage("nothing", [] {});
      tell_(stages);
      return;
    }
    // This is the last frame of the block; the clock is probed after it.
    const int measured = ++frames_ - framesBefore;
    if (measured > 0 && measured % framesOfBlock == 0) tell_(measured / framesOfBlock - 1);
  }
  Status status() override { return {}; }

 private:
  std::function<void(int)> tell_;
  int frames_ = 0;
};

class Measuring : public GpuTest {
 protected:
  Measurement measure(const std::function<void(int block)>& tell, ClockWatch* clock,
                      const MeasureSettings& settings = smallSettings()) {
    RenderFixture fixture(randomSoup(1, 4), 32, 32);
    BlockTeller method(tell);
    std::vector<Measurement> done;
    measureInterleaved(fixture.renderer(), fixture.defaultView(), {&method}, settings, clock,
                       [&](std::size_t, Measurement m) { done.push_back(std::move(m)); });
    EXPECT_EQ(done.size(), 1u);
    return done.empty() ? Measurement() : std::move(done.front());
  }
};

std::vector<std::uint32_t> blocksOf(const Series& series) {
  std::vector<std::uint32_t> blocks = series.block;
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

TEST_F(Measuring, WithoutAClockAllBlocksAreKept) {
  const Measurement m = measure([](int) {}, nullptr);
  EXPECT_EQ(m.failure, "");
  EXPECT_FALSE(m.clock);
  EXPECT_THAT(blocksOf(m.frame), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(m.stopReason, "max_blocks");
  EXPECT_EQ(m.stages.at("nothing").ms.size(), 2u);
}

TEST_F(Measuring, ASteadyClockRejectsNothing) {
  MadeUpClock clock;
  const Measurement m = measure([](int) {}, &clock.watch);
  EXPECT_THAT(blocksOf(m.frame), ElementsAre(0, 1, 2, 3, 4, 5));
  ASSERT_TRUE(m.clock);
  EXPECT_TRUE(m.clock->settled);
  EXPECT_EQ(m.clock->rejectedBlocks, 0u);
  EXPECT_EQ(m.clock->bestMs, 1);
  EXPECT_EQ(m.clock->medianMs, 1);
}

TEST_F(Measuring, BlocksInWhichTheClockFellAreRejectedAndTheCellEnds) {
  MadeUpClock clock;
  const Measurement m = measure(
      [&](int block) {
        if (block == 1 || block == 4) clock.slowProbes = 3;
      },
      &clock.watch);
  EXPECT_EQ(m.failure, "");
  EXPECT_THAT(blocksOf(m.frame), ElementsAre(0, 2, 3, 5));
  EXPECT_LE(m.frame.ms.size() + m.rejectedSamples, 6u * 3u);
  EXPECT_EQ(m.blocks, 6u);
  EXPECT_EQ(m.stopReason, "max_blocks");
  ASSERT_TRUE(m.clock);
  EXPECT_EQ(m.clock->rejectedBlocks, 2u);
  EXPECT_EQ(m.clock->unsettledBlocks, 0u);
  EXPECT_TRUE(m.clock->settled);
}

TEST_F(Measuring, RejectedBlocksDoNotMakeACellStopEarly) {
  MeasureSettings settings = smallSettings();
  settings.stop.relativeSpread = 1e9;  // reached as soon as there are enough blocks
  settings.stop.minBlocks = 3;
  MadeUpClock clock;
  const Measurement m = measure(
      [&](int block) {
        if (block == 0 || block == 2) clock.slowProbes = 3;
      },
      &clock.watch, settings);
  EXPECT_THAT(blocksOf(m.frame), ElementsAre(1, 3, 4));
  EXPECT_EQ(m.stopReason, "spread");
}

TEST_F(Measuring, BlocksOfAThrottledDeviceAreKeptAndCounted) {
  MadeUpClock clock;
  const Measurement m = measure(
      [&](int block) {
        if (block == 1) clock.ms = 1.2;
      },
      &clock.watch);
  EXPECT_THAT(blocksOf(m.frame), ElementsAre(0, 2, 3, 4, 5));
  ASSERT_TRUE(m.clock);
  EXPECT_EQ(m.clock->rejectedBlocks, 1u);
  EXPECT_EQ(m.clock->unsettledBlocks, 4u);
  EXPECT_FALSE(m.clock->settled);
  EXPECT_EQ(m.clock->bestMs, 1);
  EXPECT_EQ(m.clock->medianMs, 1.2);
}

TEST_F(Measuring, AClockThatFallsDuringTheStagesIsTold) {
  MadeUpClock clock;
  const Measurement m = measure(
      [&](int block) {
        if (block == stages) clock.slowProbes = 3;
      },
      &clock.watch);
  ASSERT_TRUE(m.clock);
  EXPECT_EQ(m.clock->rejectedBlocks + m.clock->unsettledBlocks, 0u);
  EXPECT_FALSE(m.clock->settled);
}

TEST_F(Measuring, ACellOfWhichAllBlocksAreRejectedFailsWithTheReason) {
  MadeUpClock clock;
  const Measurement m = measure([&](int) { clock.slowProbes = 3; }, &clock.watch);
  EXPECT_THAT(m.failure, HasSubstr("clock changed by more than 5% in each of 6 blocks"));
  EXPECT_THAT(m.failure, HasSubstr("--lock-gpu-clocks"));
}

class ClockProbes : public GpuTest {
 protected:
  /// The shortest of several times, because other programs can only make it longer.
  static double shortest(ClockProbe& probe) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 7; ++i) {
      const double ms = probe.run().value_or(0);
      EXPECT_GT(ms, 0);
      best = std::min(best, ms);
    }
    return best;
  }
};

TEST_F(ClockProbes, TimeGrowsWithTheWork) {
  ClockProbe probe(sharedDevice(), 64, 128), longer(sharedDevice(), 64, 1024),
      wider(sharedDevice(), 512, 128);
  const double once = shortest(probe);
  // Eight times the work. Only half of that is required, because a submission has its own cost and
  // the machine has other work.
  EXPECT_GT(shortest(longer), 4 * once);
  if (sharedDevice().info().isCpu()) {  // 64 workgroups do not fill a GPU
    EXPECT_GT(shortest(wider), 4 * once);
  }
}

TEST_F(ClockProbes, ASlowDeviceGetsLess) {
  constexpr std::uint32_t groups = 1024;
  ClockProbe probe(sharedDevice(), groups);
  probe.fit();
  EXPECT_GE(probe.groups(), 1u);
  if (!sharedDevice().info().isCpu()) return;
  // 2 G fma take a CPU device longer than 8 ms, unless it has about 100 cores.
  EXPECT_LT(probe.groups(), groups);
}

}  // namespace
}  // namespace oitlab::testing
