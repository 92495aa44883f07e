#include "measure/statistics.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace oitlab {
namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

double quantile(std::vector<double> sorted, double q) {
  return quantileOfSorted(sorted, q);
}

/// Each sample a block of its own.
std::vector<std::uint32_t> blocksOfOne(std::size_t count) {
  std::vector<std::uint32_t> blocks(count);
  std::iota(blocks.begin(), blocks.end(), 0U);
  return blocks;
}

Summary summarizeEach(const std::vector<double>& samples) {
  return summarize(samples, blocksOfOne(samples.size()));
}

TEST(Quantile, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(quantile({7}, 0.5), 7);
  EXPECT_EQ(quantile({1, 2, 10}, 0.5), 2);
  EXPECT_EQ(quantile({1, 2, 4, 10}, 0.5), 3);
}

TEST(Quantile, IsType7) {
  // (n - 1) q = 0.75: three quarters of the way from 1 to 2.
  EXPECT_DOUBLE_EQ(quantile({1, 2, 4, 10}, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile({1, 2, 4, 10}, 0.75), 5.5);
  EXPECT_EQ(quantile({1, 2, 4, 10}, 0), 1);
  EXPECT_EQ(quantile({1, 2, 4, 10}, 1), 10);
}

TEST(QuantileDeathTest, RefusesNonsense) {
  EXPECT_DEATH(quantile({}, 0.5), "check failed");
  EXPECT_DEATH(quantile({1}, 1.5), "check failed");
  EXPECT_DEATH(quantile({1}, notANumber), "check failed");
}

TEST(Summarize, ValuesWorkedOutByHand) {
  // 1 ... 101, shuffled: the quantile for q is 1 + 100 q.
  std::vector<double> samples(101);
  std::iota(samples.begin(), samples.end(), 1.0);
  std::shuffle(samples.begin(), samples.end(), std::mt19937(1));
  const Summary summary = summarizeEach(samples);
  EXPECT_EQ(summary.count, 101U);
  EXPECT_EQ(summary.min, 1);
  EXPECT_EQ(summary.q1, 26);
  EXPECT_EQ(summary.median, 51);
  EXPECT_EQ(summary.q3, 76);
  EXPECT_EQ(summary.p95, 96);  // not the median again
  EXPECT_EQ(summary.max, 101);
  EXPECT_EQ(summary.mean, 51);
  EXPECT_EQ(summary.blocks, 101U);
  ASSERT_TRUE(summary.ci95);
  EXPECT_LT(summary.ci95->first, 51);
  EXPECT_GT(summary.ci95->second, 51);
}

TEST(Summarize, NothingGivesZeros) {
  const Summary summary = summarizeEach({});
  EXPECT_EQ(summary.count, 0U);
  EXPECT_EQ(summary.median, 0);
  EXPECT_FALSE(summary.ci95);
}

TEST(Summarize, FewBlocksHaveNoInterval) {
  // One sample had an interval of no width, as if it were known exactly.
  std::vector<double> samples;
  for (std::uint64_t count = 1; count < fewestBlocks; ++count) {
    samples.push_back(double(count));
    const Summary summary = summarizeEach(samples);
    EXPECT_EQ(summary.blocks, count);
    EXPECT_FALSE(summary.ci95) << count << " blocks";
  }
  samples.push_back(6);
  const Summary summary = summarizeEach(samples);
  ASSERT_TRUE(summary.ci95);
  EXPECT_LT(summary.ci95->first, summary.ci95->second);
  // Frames of one block are not independent, however many there are.
  const Summary oneBlock = summarize(samples, std::vector<std::uint32_t>(samples.size(), 3));
  EXPECT_EQ(oneBlock.blocks, 1U);
  EXPECT_FALSE(oneBlock.ci95);
}

TEST(Summarize, SamplesThatAreNotFiniteAreCountedAndLeftOut) {
  const Summary summary = summarizeEach({notANumber, 2, infinite, 1, 3, -infinite});
  EXPECT_EQ(summary.count, 3U);
  EXPECT_EQ(summary.notFinite, 3U);
  EXPECT_EQ(summary.median, 2);
  EXPECT_EQ(summary.max, 3);
  EXPECT_EQ(summarizeEach({notANumber}).count, 0U);
  EXPECT_EQ(summarizeEach({notANumber}).notFinite, 1U);
}

TEST(Summarize, IsDeterministicFromTheSeed) {
  std::vector<double> samples(60);
  std::vector<std::uint32_t> blocks(60);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < 60; ++i) {
    samples[i] = double(random() % 1000);
    blocks[i] = std::uint32_t(i / 5);
  }
  const Summary a = summarize(samples, blocks, 7);
  const Summary b = summarize(samples, blocks, 7);
  const Summary c = summarize(samples, blocks, 8);
  ASSERT_TRUE(a.ci95);
  EXPECT_EQ(a.ci95, b.ci95);
  EXPECT_NE(a.ci95, c.ci95);
}

TEST(Summarize, BlocksAreDrawnWhole) {
  // Six blocks, however numbered, three of ones and three of twos, each constant: a draw of six
  // blocks has a median of 1, 1.5 or 2, and each is frequent. Draws of single frames, 150 of each,
  // would hardly ever leave 1.5.
  std::vector<double> samples;
  std::vector<std::uint32_t> blocks;
  for (int i = 0; i < 50; ++i)
    for (const std::uint32_t block : {900U, 7U, 8U, 31U, 2U, 5U}) {
      samples.push_back(block % 2 == 0 ? 1.0 : 2.0);
      blocks.push_back(block);
    }
  const Summary summary = summarize(samples, blocks);
  EXPECT_EQ(summary.median, 1.5);
  ASSERT_TRUE(summary.ci95);
  EXPECT_EQ(summary.ci95->first, 1);
  EXPECT_EQ(summary.ci95->second, 2);
}

TEST(Summarize, IntervalsCoverTheTruth) {
  // Frames of a block share most of their noise, as they do when a clock drifts. The interval
  // should contain the true median (10) in about 95 of 100 cases, somewhat less with 20 blocks. An
  // interval that treats frames as independent contains it little more than half of the time.
  std::mt19937_64 random(42);
  std::normal_distribution<double> normal;
  constexpr int trials = 200;
  int covered = 0;
  int coveredByFrames = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> samples;
    std::vector<std::uint32_t> blocks;
    for (std::uint32_t block = 0; block < 20; ++block) {
      const double shared = 10 + normal(random);
      for (int frame = 0; frame < 4; ++frame) {
        samples.push_back(shared + 0.2 * normal(random));
        blocks.push_back(block);
      }
    }
    const Summary byBlocks = summarize(samples, blocks, 1, 200);
    covered += byBlocks.ci95->first <= 10 && 10 <= byBlocks.ci95->second;
    const Summary byFrames = summarize(samples, blocksOfOne(samples.size()), 1, 200);
    coveredByFrames += byFrames.ci95->first <= 10 && 10 <= byFrames.ci95->second;
  }
  EXPECT_GE(covered, trials * 86 / 100);
  EXPECT_LE(covered, trials * 99 / 100);
  EXPECT_LE(coveredByFrames, trials * 75 / 100);
}

}  // namespace
}  // namespace oitlab
