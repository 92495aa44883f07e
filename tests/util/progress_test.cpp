#include "util/progress.h"

#include <memory>

#include <gtest/gtest.h>

namespace oitlab {
namespace {

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

TEST(Progress, RewritesItsLineAndClearsIt) {
  const File file(std::tmpfile(), std::fclose);
  {
    Progress progress(2, true, file.get());
    progress.show(0, "first", std::nullopt);
    progress.show(1, "second", 0.2);
  }
  EXPECT_EQ(contentOf(file.get()), "[0/2] first\r\x1b[K[1/2] second   00:01 left\r\x1b[K");
}

TEST(Progress, IsSilentAwayFromATerminal) {
  const File file(std::tmpfile(), std::fclose);
  {
    Progress progress(2, false, file.get());
    progress.show(0, "first", 3.0);
  }
  EXPECT_EQ(contentOf(file.get()), "");
}

TEST(Progress, KnowsThatAFileIsNoTerminal) {
  const File file(std::tmpfile(), std::fclose);
  EXPECT_FALSE(isTerminal(file.get()));
}

}  // namespace
}  // namespace oitlab
