// Parameters: every given value is checked against the declaration.
#include "method/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "util/error.h"

namespace oitlab::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<Parameter> declared = {
    choice("mode", {"fast", "exact"}, "how"), integer("layers", 4, 1, 16, "how many"),
    real("scale", 0.5, 0.0, 2.0, "how large", "m"), flag("repair", true, "whether")};

std::string errorOf(const std::map<std::string, std::string>& given) {
  try {
    Parameters(declared, given, "toy");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParametersTest, DefaultsAndGivenValues) {
  const Parameters defaults(declared, {}, "toy");
  EXPECT_EQ(defaults.choice("mode"), "fast");
  EXPECT_EQ(defaults.integer("layers"), 4);
  EXPECT_EQ(defaults.real("scale"), 0.5);
  EXPECT_TRUE(defaults.flag("repair"));
  const Parameters given(
      declared, {{"mode", "exact"}, {"layers", "16"}, {"scale", "2"}, {"repair", "off"}}, "toy");
  EXPECT_EQ(given.choice("mode"), "exact");
  EXPECT_EQ(given.integer("layers"), 16);
  EXPECT_EQ(given.real("scale"), 2.0);
  EXPECT_FALSE(given.flag("repair"));
  EXPECT_EQ(given.toJson().dump(), R"({"layers":16,"mode":"exact","repair":false,"scale":2.0})");
}

TEST(ParametersTest, WrongOnesAreNamedWithTheRange) {
  EXPECT_THAT(errorOf({{"layrs", "2"}}),
              AllOf(HasSubstr("toy"), HasSubstr("did you mean 'layers'")));
  EXPECT_THAT(errorOf({{"layers", "17"}}), AllOf(HasSubstr("17"), HasSubstr("1 to 16")));
  EXPECT_THAT(errorOf({{"layers", "0"}}), HasSubstr("out of range"));
  EXPECT_THAT(errorOf({{"layers", "2.5"}}), HasSubstr("not a whole number"));
  EXPECT_THAT(errorOf({{"layers", ""}}), HasSubstr("not a whole number"));
  EXPECT_THAT(errorOf({{"scale", "2.1"}}), HasSubstr("0 to 2 m"));
  EXPECT_THAT(errorOf({{"scale", "nan"}}), HasSubstr("out of range"));
  EXPECT_THAT(errorOf({{"mode", "exakt"}}), HasSubstr("did you mean 'exact'"));
  EXPECT_THAT(errorOf({{"repair", "maybe"}}), HasSubstr("on | off"));
}

}  // namespace
}  // namespace oitlab::testing
