#include "util/json_file.h"

#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using JsonFile = TemporaryFolder;

std::string failureOf(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return messageOf<InputError>([&] { readJsonFile(path); });
}

TEST_F(JsonFile, KeepsValues) {
  const nlohmann::json value = {{"name", "boxes"}, {"times", {0.1, 1e-9, 3}}, {"none", nullptr}};
  writeJsonFile(folder_ / "a.json", value);
  EXPECT_EQ(readJsonFile(folder_ / "a.json"), value);
  EXPECT_EQ(readTextFile(folder_ / "a.json").back(), '\n');
  EXPECT_THAT(filesInFolder(), ElementsAre("a.json"));
}

TEST_F(JsonFile, WritesWhatJsonLacksAsNullOrReplacement) {
  writeJsonFile(folder_ / "a.json",
                {{"psnr", std::numeric_limits<double>::infinity()}, {"driver", "Mesa \xFF"}});
  const nlohmann::json read = readJsonFile(folder_ / "a.json");
  EXPECT_TRUE(read["psnr"].is_null());
  EXPECT_EQ(read["driver"], "Mesa \xEF\xBF\xBD");
}

TEST_F(JsonFile, ReplacesTheOldFile) {
  writeJsonFile(folder_ / "a.json", {{"long", std::string(1000, 'x')}});
  writeJsonFile(folder_ / "a.json", {{"short", 1}});
  EXPECT_EQ(readJsonFile(folder_ / "a.json"), (nlohmann::json{{"short", 1}}));
}

TEST_F(JsonFile, FailedWritesLeaveNothing) {
  const auto write = [](const std::filesystem::path& path) {
    return messageOf<InputError>([&] { writeJsonFile(path, {{"a", 1}}); });
  };
  EXPECT_THAT(write(folder_ / "absent" / "a.json"),
              HasSubstr("a.json: cannot be written: No such"));
  std::filesystem::create_directories(folder_ / "b.json" / "inner");
  EXPECT_THAT(write(folder_ / "b.json"), HasSubstr("b.json: cannot be written"));
  EXPECT_THAT(filesInFolder(), ElementsAre("b.json"));
}

TEST_F(JsonFile, NamesThePlaceOfAnError) {
  const std::filesystem::path path = folder_ / "a.json";
  // The invalid letter is the 7th byte of the file, in column 5 of line 2.
  const std::string message = failureOf(path, "{\n\"a\":x}");
  EXPECT_THAT(message, HasSubstr(path.string() + ":2:5: not valid JSON at byte 7: "));
  EXPECT_THAT(message, HasSubstr("invalid literal"));
  EXPECT_EQ(message.find("json.exception"), std::string::npos);
}

TEST_F(JsonFile, NamesThePlaceWhereAFileStopsEarly) {
  const std::filesystem::path path = folder_ / "a.json";
  EXPECT_THAT(failureOf(path, ""), HasSubstr("a.json:1:1: not valid JSON at byte 1"));
  EXPECT_THAT(failureOf(path, "{\"a\": [1,\n 2"),
              HasSubstr("a.json:2:3: not valid JSON at byte 13"));
  EXPECT_THAT(failureOf(path, "{} {}"), HasSubstr("a.json:1:4"));
}

TEST_F(JsonFile, NamesAFileThatIsNotThere) {
  EXPECT_THAT(messageOf<InputError>([&] { readJsonFile(folder_ / "no.json"); }),
              HasSubstr("no.json: cannot be opened: No such file"));
}

TEST_F(JsonFile, TextKeepsEveryByte) {
  const std::string bytes("a\0\r\n\xFF", 5);
  writeFileAtomically(folder_ / "a", bytes);
  EXPECT_EQ(readTextFile(folder_ / "a"), bytes);
  const std::string large(200000, 'z');  // more than one chunk
  writeFileAtomically(folder_ / "a", large);
  EXPECT_EQ(readTextFile(folder_ / "a"), large);
}

}  // namespace
}  // namespace oitlab
