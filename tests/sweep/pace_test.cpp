// How long a sweep takes, told before and while it goes on.
#include "sweep/pace.h"

#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

MeasureSettings settings() {
  MeasureSettings settings;
  settings.stop = {.relativeSpread = 0.005,
                   .minBlocks = 10,
                   .settleWindow = 5,
                   .timeLimitSeconds = 10,
                   .maxBlocks = 200};
  settings.blockSeconds = 0.05;
  return settings;
}

constexpr GroupSize group{.cells = 4, .megapixels = 2};

std::vector<MeasureProgress> allAt(std::uint32_t blocks, double seconds, bool finished) {
  return std::vector<MeasureProgress>(group.cells, {blocks, seconds, finished});
}

TEST(Pace, OnACpuACellTakesItsTimeLimit) {
  const Pace pace(settings(), true);
  const Pace none(settings(), true);
  const double one = pace.secondsOf({1, 0}) - pace.secondsOf({0, 0});
  EXPECT_GT(one, 10);
  EXPECT_LT(one, 10.5);
}

TEST(Pace, OnAGpuACellTakesLittleMoreThanItsFewestBlocks) {
  const Pace pace(settings(), false);
  const double one = pace.secondsOf({1, 0}) - pace.secondsOf({0, 0});
  EXPECT_GT(one, 10 * 0.05);
  EXPECT_LT(one, 2);
}

TEST(Pace, LearnsFromTheGroupsThatAreDone) {
  Pace pace(settings(), false);
  pace.learn(group, allAt(25, 3, true), 4 * 3 + 8);
  EXPECT_NEAR(pace.secondsOf(group), 20, 1e-9);
  pace.learn(group, allAt(25, 3, true), 4 * 3 + 16);
  EXPECT_NEAR(pace.secondsOf(group), 24, 1e-9);
  EXPECT_NEAR(pace.secondsOf({8, 2}), 2 * 24, 3);
}

TEST(Pace, WithinAGroupWhatIsDoneIsNoLongerLeft) {
  Pace pace(settings(), true);
  const double before = pace.secondsLeft(group, {}, 0);
  EXPECT_NEAR(before, pace.secondsOf(group), 1e-9);
  // Blocks of 0.5 s: 20 to the time limit, of which 10 are done.
  const double half = pace.secondsLeft(group, allAt(10, 5, false), 4 * 5 + 100);
  const double around = 0.5 + 4 * (0.1 + 0.3 * 2);
  EXPECT_NEAR(half, 4 * 0.5 * 10.5 + 0.5 * around, 1e-9);
  EXPECT_EQ(pace.secondsLeft(group, allAt(20, 10, true), 4 * 10 + 100), 0);
}

TEST(Pace, LongerThanExpectedStillLeavesABlock) {
  Pace pace(settings(), false);
  const double left = pace.secondsLeft(group, allAt(100, 9, false), 1e3);
  EXPECT_GE(left, 4 * 0.09);
  EXPECT_LT(left, 4 * 0.09 + pace.secondsOf(group));
}

class PaceFiles : public TemporaryFolder {};

TEST_F(PaceFiles, WhatWasLearnedIsKeptFromRunToRun) {
  const auto file = folder_ / "pace" / "device.json";
  Pace first(settings(), false);
  first.learn(group, allAt(25, 3, true), 4 * 3 + 30);
  first.save(file);
  Pace second(settings(), false);
  const double unknowing = second.secondsOf(group);
  second.load(file);
  EXPECT_NEAR(second.secondsOf(group) - unknowing, 30 - (0.5 + 4 * (0.1 + 0.3 * 2)), 1e-6);
  for (const char* broken :
       {"", "{}", "[1]", "{\"overhead_seconds\": -1, \"overhead_model\": 0}"}) {
    writeFileAtomically(file, broken);
    Pace third(settings(), false);
    third.load(file);
    EXPECT_EQ(third.secondsOf(group), unknowing) << broken;
  }
}

/// A sweep of made-up groups: at any moment past the first group the time left is right within a
/// factor of 1.5, although cells differ.
TEST(Pace, IsRightWithinAFactorOfOneAndAHalf) {
  Pace pace(settings(), false);
  const auto cellSecondsOf = [](int index) { return 1.0 + 0.2 * (index * 7 % 5); };
  constexpr int groups = 12;
  double total = 0;
  for (int g = 0; g < groups; ++g) total += 4 * cellSecondsOf(g) + 2;
  double passed = 0;
  for (int g = 0; g < groups; ++g) {
    const double seconds = 4 * cellSecondsOf(g);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const auto blocks = std::uint32_t(20 * share);
      const auto progress = share == 0 ? std::vector<MeasureProgress>()
                                       : allAt(blocks, seconds / 4 * share, share == 1);
      const double elapsed = seconds * share + 1;
      double left = pace.secondsLeft(group, progress, elapsed);
      left += (groups - 1 - g) * pace.secondsOf(group);
      const double truth = total - passed - elapsed;
      if (g == 0 || truth < 2) continue;
      EXPECT_LT(left, truth * 1.5) << "group " << g << " at " << share;
      EXPECT_GT(left, truth / 1.5) << "group " << g << " at " << share;
    }
    pace.learn(group, allAt(20, seconds / 4, true), seconds + 2);
    passed += seconds + 2;
  }
}

}  // namespace
}  // namespace oitlab
