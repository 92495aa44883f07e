#include "util/rounding.h"

#include <limits>

#include <gtest/gtest.h>

namespace oitlab {
namespace {

TEST(Rounding, DividesUp) {
  EXPECT_EQ(divideUp(0u, 32u), 0u);
  EXPECT_EQ(divideUp(1u, 32u), 1u);
  EXPECT_EQ(divideUp(32u, 32u), 1u);
  EXPECT_EQ(divideUp(33u, 32u), 2u);
  constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  EXPECT_EQ(divideUp(most, 2u), 1u << 31);  // (a + b - 1) / b would have overflowed
}

TEST(Rounding, RoundsUp) {
  EXPECT_EQ(roundUp(0u, 16u), 0u);
  EXPECT_EQ(roundUp(17u, 16u), 32u);
  EXPECT_EQ(roundUp(32u, 16u), 32u);
}

TEST(Rounding, SlackIsASixteenthAndAFew) {
  EXPECT_EQ(withSlack(0), 64u);
  EXPECT_EQ(withSlack(1600), 1764u);
}

}  // namespace
}  // namespace oitlab
