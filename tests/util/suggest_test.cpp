#include "util/suggest.h"

#include <gtest/gtest.h>

namespace oitlab {
namespace {

const std::vector<std::string> methods = {"reference", "wboit", "mboit", "lucidraster", "ll"};

TEST(DidYouMean, FindsASlipOfTheHand) {
  EXPECT_EQ(didYouMean("wbiot", methods), " (did you mean 'wboit'?)");  // swap
  EXPECT_EQ(didYouMean("lucidrster", methods),
            " (did you mean 'lucidraster'?)");                                  // missing letter
  EXPECT_EQ(didYouMean("wwboit", methods), " (did you mean 'wboit'?)");         // doubled letter
  EXPECT_EQ(didYouMean("referemce", methods), " (did you mean 'reference'?)");  // wrong letter
}

TEST(DidYouMean, IgnoresCase) {
  EXPECT_EQ(didYouMean("WBOIT", methods), " (did you mean 'wboit'?)");
  EXPECT_EQ(didYouMean("width", {"Width"}), " (did you mean 'Width'?)");
}

TEST(DidYouMean, AllowsAThirdOfTheLettersAndNoMore) {
  EXPECT_EQ(didYouMean("abcxyf", {"abcdef"}), " (did you mean 'abcdef'?)");  // 2 of 6
  EXPECT_EQ(didYouMean("abxyzf", {"abcdef"}), "");                           // 3 of 6
  EXPECT_EQ(didYouMean("ab", {"ac"}), " (did you mean 'ac'?)");              // at least one
}

TEST(DidYouMean, CountsASwapAsOneSlip) {
  // Five letters allow one edit. A swap must count as one edit, not as two substitutions.
  EXPECT_EQ(didYouMean("baxes", {"abxes"}), " (did you mean 'abxes'?)");
}

TEST(DidYouMean, CompletesAnAbbreviation) {
  EXPECT_EQ(didYouMean("ref", methods), " (did you mean 'reference'?)");
  EXPECT_EQ(didYouMean("Lucid", methods), " (did you mean 'lucidraster'?)");
  EXPECT_EQ(didYouMean("hair", {"hairballs_and_more", "hairball_scene"}),
            " (did you mean 'hairball_scene'?)");
}

TEST(DidYouMean, PrefersASlipToAnAbbreviation) {
  EXPECT_EQ(didYouMean("pipe", {"pipes_of_steel", "pipa"}), " (did you mean 'pipa'?)");
}

TEST(DidYouMean, StaysSilentWhenNothingIsClose) {
  EXPECT_EQ(didYouMean("hairball", methods), "");
  EXPECT_EQ(didYouMean("r", methods), "");
  EXPECT_EQ(didYouMean("x", {"y"}), "");
  EXPECT_EQ(didYouMean("", methods), "");
  EXPECT_EQ(didYouMean("wboit", {}), "");
}

TEST(JoinNames, SeparatesWithCommas) {
  EXPECT_EQ(joinNames({}), "");
  EXPECT_EQ(joinNames({"a"}), "a");
  EXPECT_EQ(joinNames({"a", "b", "c"}), "a, b, c");
}

}  // namespace
}  // namespace oitlab
