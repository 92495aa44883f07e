#include "util/progress.h"

#include <memory>

#include <gtest/gtest.h>

namespace oitlab {
namespace {

TEST(EstimateSecondsLeft, IsTheMeanOfTheDoneTimesTheRemaining) {
  EXPECT_EQ(estimateSecondsLeft(3, 12, 6.0), 18.0);
  EXPECT_EQ(estimateSecondsLeft(12, 12, 6.0), 0.0);
  EXPECT_EQ(estimateSecondsLeft(13, 12, 6.0), 0.0);
}

TEST(EstimateSecondsLeft, IsUnknownBeforeTheFirstCellIsDone) {
  EXPECT_EQ(estimateSecondsLeft(0, 12, 6.0), std::nullopt);
  EXPECT_EQ(estimateSecondsLeft(3, 12, 0.0), std::nullopt);
}

TEST(FormatSeconds, ShowsMinutesOrHours) {
  EXPECT_EQ(formatSeconds(0), "00:00");
  EXPECT_EQ(formatSeconds(11.2), "00:12");
  EXPECT_EQ(formatSeconds(59.5), "01:00");
  EXPECT_EQ(formatSeconds(754), "12:34");
  EXPECT_EQ(formatSeconds(3723), "1:02:03");
  EXPECT_EQ(formatSeconds(3600 * 123.5), "123 h");
}

TEST(ProgressLine, ShowsDoneLabelAndEstimate) {
  EXPECT_EQ(progressLine(3, 12, "boxes reference 640x360", 11.5, 80),
            "[ 3/12] boxes reference 640x360   00:12 left");
  EXPECT_EQ(progressLine(0, 5, "boxes", std::nullopt, 80), "[0/5] boxes");
}

TEST(ProgressLine, CutsTheLabelRatherThanWrapping) {
  EXPECT_EQ(progressLine(3, 12, "boxes reference 640x360", 11.5, 26), "[ 3/12] boxes   00:12 left");
  EXPECT_EQ(progressLine(3, 12, "boxes", 11.5, 4), "[ 3/12]    00:12 left");
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string contentOf(std::FILE* file) {
  std::rewind(file);
  char text[400];
  return std::string(text, std::fread(text, 1, sizeof text, file));
}

/// The text that a Progress of two cells prints.
std::string printed(bool enabled, bool verbose) {
  const File file(std::tmpfile(), std::fclose);
  Progress progress(2, enabled, verbose, file.get());
  progress.begin("first");
  progress.finish();
  progress.begin("second");
  progress.finish();
  return contentOf(file.get());
}

TEST(Progress, RewritesItsLineAndClearsIt) {
  EXPECT_EQ(printed(true, false), "[0/2] first\r\x1b[K[1/2] second   00:01 left\r\x1b[K");
}

TEST(Progress, ClearsItsLineWhenASweepIsCutShort) {
  const File file(std::tmpfile(), std::fclose);
  {
    Progress progress(2, true, false, file.get());
    progress.begin("first");
  }
  EXPECT_EQ(contentOf(file.get()), "[0/2] first\r\x1b[K");
}

TEST(Progress, IsSilentOrPlainAwayFromATerminal) {
  EXPECT_EQ(printed(false, false), "");
  EXPECT_EQ(printed(false, true), "[1/2] first\n[2/2] second\n");
}

TEST(Progress, KnowsThatAFileIsNoTerminal) {
  const File file(std::tmpfile(), std::fclose);
  EXPECT_FALSE(isTerminal(file.get()));
}

}  // namespace
}  // namespace oitlab
