#include "frame/frame_timer.h"

#include <gtest/gtest.h>

namespace oitlab {
namespace {

TEST(FrameTimer, MasksTimestampsAndRejectsWhatRunsBackwards) {
  EXPECT_EQ(FrameTimer::ticksBetween(10, 25, 64), 15u);
  EXPECT_EQ(FrameTimer::ticksBetween(250, 4, 8), 10u);        // the 8-bit counter wrapped
  EXPECT_EQ(FrameTimer::ticksBetween(0x1fa, 0x204, 8), 10u);  // bits beyond the valid ones differ
  EXPECT_EQ(FrameTimer::ticksBetween(7, 7, 64), std::nullopt);
  EXPECT_EQ(FrameTimer::ticksBetween(25, 10, 64), std::nullopt);
  EXPECT_EQ(FrameTimer::ticksBetween(25, 10, 36), std::nullopt);
}

}  // namespace
}  // namespace oitlab
