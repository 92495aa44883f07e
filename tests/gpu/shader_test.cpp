// The cache of compiled shaders: whatever is in its place, the SPIR-V is right.
#include "gpu/shader.h"

#include <gmock/gmock.h>

#include "support/environment.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

using ::testing::HasSubstr;

/// A folder shaders/ with one shader, and a cache, both of the test.
class ShaderCache : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    root_.emplace("OITLAB_ROOT", folder_.string());
    cache_.emplace("OITLAB_CACHE", (folder_ / "cache").string());
    write("1.5");
  }
  void TearDown() override {
    cache_.reset();
    root_.reset();
    TemporaryFolder::TearDown();
  }

  void write(const std::string& constant) {
    std::filesystem::create_directories(folder_ / "shaders");
    writeFileAtomically(folder_ / "shaders" / "x.comp",
                        "layout(local_size_x = 1) in;\n"
                        "layout(buffer_reference, scalar) buffer Value { float value; };\n"
                        "layout(push_constant, scalar) uniform Push { Value to; };\n"
                        "void main() { to.value = float(FACTOR) * " +
                            constant + "; }\n");
  }
  static std::vector<std::uint32_t> compile(const char* factor = "1") {
    return ShaderLibrary().compile("x.comp", {{"FACTOR", factor}});
  }
  std::filesystem::path spirv() const { return folder_ / "cache" / "spirv"; }
  std::filesystem::path file() const {
    return std::filesystem::directory_iterator(spirv())->path();
  }
  std::size_t files() const {
    return std::size_t(std::distance(std::filesystem::directory_iterator(spirv()), {}));
  }

 private:
  std::optional<ScopedEnvironment> root_, cache_;
};

TEST_F(ShaderCache, HasOneFilePerTextAndDefinitions) {
  const auto words = compile();
  EXPECT_EQ(files(), 1u);
  const auto written = std::filesystem::last_write_time(file()) - std::chrono::hours(1);
  std::filesystem::last_write_time(file(), written);
  EXPECT_EQ(compile(), words);
  EXPECT_EQ(std::filesystem::last_write_time(file()), written);  // read, not written again
  EXPECT_NE(compile("2"), words);
  EXPECT_EQ(files(), 2u);
  write("2.5");
  EXPECT_NE(compile(), words);
  EXPECT_EQ(files(), 3u);
}

TEST_F(ShaderCache, AFlippedBitIsCompiledAnew) {
  const auto words = compile();
  const std::string good = readTextFile(file());
  for (std::size_t byte = 0; byte < good.size(); byte += 13) {
    std::string bad = good;
    bad[byte] = char(bad[byte] ^ 4);
    writeFileAtomically(file(), bad);
    ASSERT_EQ(compile(), words) << "byte " << byte;
    ASSERT_EQ(readTextFile(file()), good) << "byte " << byte;
  }
}

TEST_F(ShaderCache, TheFileOfAnotherShaderIsCompiledAnew) {
  const auto one = compile("1");
  const auto first = file();
  const std::string content = readTextFile(first);
  std::filesystem::remove(first);
  const auto two = compile("2");
  writeFileAtomically(file(), content);
  EXPECT_EQ(compile("2"), two);
}

TEST_F(ShaderCache, AFolderOrAnythingElseInThePlaceDoesNoHarm) {
  const auto words = compile();
  const auto place = file();
  std::filesystem::remove(place);
  std::filesystem::create_directories(place / "not empty");
  EXPECT_EQ(compile(), words);
  std::filesystem::remove_all(place);
  std::filesystem::create_symlink("nowhere", place);
  EXPECT_EQ(compile(), words);
  std::filesystem::remove_all(folder_ / "cache");
  writeFileAtomically(folder_ / "cache", "a file where the folder should be");
  EXPECT_EQ(compile(), words);
}

TEST_F(ShaderCache, APrintingShaderNeedsTheSwitch) {
  writeFileAtomically(folder_ / "shaders" / "x.comp",
                      "layout(local_size_x = 1) in;\n"
                      "void main() { debugPrintfEXT(\"%u\", gl_GlobalInvocationID.x); }\n");
  EXPECT_FALSE(ShaderLibrary(true).compile("x.comp").empty());
  EXPECT_THAT(messageOf<InputError>([] { ShaderLibrary().compile("x.comp"); }),
              HasSubstr("shaders/x.comp"));
}

}  // namespace
}  // namespace oitlab
