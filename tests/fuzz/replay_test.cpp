// Every file of tests/fuzz/corpus once through its target, without libFuzzer: seeds, and inputs
// that once did harm.
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "fuzz/targets.h"
#include "util/paths.h"

namespace oitlab {
namespace {

TEST(FuzzCorpus, IsReadOrRefused) {
  const auto corpus = dataRoot() / "tests" / "fuzz" / "corpus";
  if (!std::filesystem::is_directory(corpus)) GTEST_SKIP() << "no sources here, as in a bundle";
  const LowSceneLimits limits;
  for (const auto& [name, parse] : fuzzTargets()) {
    if (name == "spirv_cache") continue;  // sets OITLAB_ROOT; tests/gpu/shader_test.cpp covers it
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(corpus / name)) {
      SCOPED_TRACE(entry.path().string());
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      EXPECT_NO_THROW(parse(bytes));
      ++files;
    }
    EXPECT_GT(files, 0u) << name;
  }
}

}  // namespace
}  // namespace oitlab
