#include "measure/stop_rule.h"

#include <limits>

#include <gtest/gtest.h>

namespace oitlab {
namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

StopRule ruleOf(double seconds, const std::vector<double>& medians,
                StopRule::Limits limits = {.minBlocks = 5}) {
  StopRule rule(limits);
  for (const double median : medians) rule.addBlock(median, seconds);
  return rule;
}

TEST(StopRule, SpreadIsInterquartileRangeOverMedian) {
  // Quartiles 1.75 and 5.5, median 3.
  EXPECT_DOUBLE_EQ(ruleOf(0, {4, 1, 10, 2}).relativeSpread(), 1.25);
  EXPECT_EQ(ruleOf(0, {}).relativeSpread(), infinite);
  EXPECT_EQ(ruleOf(0, {0, 0}).relativeSpread(), infinite);
}

TEST(StopRule, StopsAtASmallSpreadButNotEarly) {
  EXPECT_EQ(ruleOf(0, {}).stopReason(), "");
  EXPECT_EQ(ruleOf(0, {10, 10, 10, 10}).stopReason(), "");
  EXPECT_EQ(ruleOf(0, {10, 10, 10, 10, 10}).stopReason(), "spread");
  // Quartiles 9.99 and 10.01 give 0.2%; 9.9 and 10.1 give 2%.
  EXPECT_EQ(ruleOf(0, {9, 9.99, 10, 10.01, 11}).stopReason(), "spread");
  EXPECT_EQ(ruleOf(0, {9, 9.9, 10, 10.1, 11}).stopReason(), "");
}

TEST(StopRule, StopsWhenTheMedianStandsStill) {
  // The running medians are 10, 9.5, 10, 9.5, ... and never settle.
  EXPECT_EQ(ruleOf(0, {10, 9, 11, 8, 12, 7, 13, 6}).stopReason(), "");
  // They are 10, 10.5, 10, 10, 10, 10, 10, 10: constant over six values, which are five blocks,
  // after eight blocks.
  const std::vector<double> noise = {10, 11, 9, 10, 8, 10, 12, 10};
  StopRule::Limits limits{.minBlocks = 5};
  limits.relativeSpread = 0.01;
  for (std::size_t blocks = 0; blocks < noise.size(); ++blocks)
    EXPECT_EQ(
        ruleOf(0, {noise.begin(), noise.begin() + std::ptrdiff_t(blocks)}, limits).stopReason(), "")
        << blocks;
  EXPECT_EQ(ruleOf(0, noise, limits).stopReason(), "settled");
}

TEST(StopRule, StopsAtTheTimeLimitFromTheFirstBlock) {
  EXPECT_EQ(ruleOf(11, {10}).stopReason(), "time_limit");
  EXPECT_EQ(ruleOf(2.5, {10, 20, 10}).stopReason(), "");
  EXPECT_EQ(ruleOf(2.5, {10, 20, 10, 30}).stopReason(), "time_limit");
}

TEST(StopRule, SaysThatTheSpreadWasReachedEvenWhenTimeIsOutToo) {
  EXPECT_EQ(ruleOf(60, {10, 10, 10, 10, 10}).stopReason(), "spread");
}

TEST(StopRule, StopsAtTheMostBlocks) {
  StopRule::Limits limits{.minBlocks = 5};
  limits.maxBlocks = 4;
  EXPECT_EQ(ruleOf(0, {10, 9, 11}, limits).stopReason(), "");
  EXPECT_EQ(ruleOf(0, {10, 9, 11, 8}, limits).stopReason(), "max_blocks");
}

TEST(StopRule, BlocksWithoutAFrameNeitherPassNorHang) {
  EXPECT_EQ(ruleOf(0, {notANumber, notANumber, notANumber, notANumber, notANumber, notANumber})
                .stopReason(),
            "");
  EXPECT_EQ(ruleOf(5, {notANumber, notANumber}).stopReason(), "time_limit");
  EXPECT_EQ(ruleOf(0, std::vector<double>(200, notANumber)).stopReason(), "max_blocks");
  EXPECT_EQ(ruleOf(0, {10, notANumber, 10, 10, 10}).stopReason(), "");
  EXPECT_EQ(ruleOf(0, {10, notANumber, 10, 10, 10, 10}).stopReason(), "spread");
}

}  // namespace
}  // namespace oitlab
