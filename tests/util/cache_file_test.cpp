#include "util/cache_file.h"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

class CacheFile : public TemporaryFolder {
 protected:
  std::filesystem::path path() const { return folder_ / "sub" / "file"; }
};

TEST_F(CacheFile, GivesBackWhatWasWritten) {
  EXPECT_EQ(readCached(path(), "key"), std::nullopt);
  for (const std::string& content :
       {std::string(), std::string("a\0b", 3), std::string(70000, 'x')}) {
    EXPECT_TRUE(writeCached(path(), "key", content));
    EXPECT_EQ(readCached(path(), "key"), content);
  }
}

TEST_F(CacheFile, IsMissingForAnotherKey) {
  writeCached(path(), "key 1", "content");
  EXPECT_EQ(readCached(path(), "key 2"), std::nullopt);
  EXPECT_EQ(readCached(path(), ""), std::nullopt);
}

TEST_F(CacheFile, IsMissingWhereAnyBitFlipped) {
  writeCached(path(), "key", "content");
  const std::string good = readTextFile(path());
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bad = good;
    bad[bit / 8] = char(bad[bit / 8] ^ (1 << bit % 8));
    writeFileAtomically(path(), bad);
    EXPECT_EQ(readCached(path(), "key"), std::nullopt) << "bit " << bit;
  }
}

TEST_F(CacheFile, IsMissingWhereItsLengthIsAnother) {
  writeCached(path(), "key", "content");
  const std::string good = readTextFile(path());
  for (std::size_t length = 0; length < good.size(); ++length) {
    writeFileAtomically(path(), good.substr(0, length));
    EXPECT_EQ(readCached(path(), "key"), std::nullopt) << "cut to " << length;
  }
  writeFileAtomically(path(), good + '\0');
  EXPECT_EQ(readCached(path(), "key"), std::nullopt);
}

TEST_F(CacheFile, PutsUpWithWhateverIsInItsPlace) {
  std::filesystem::create_directories(path());  // a folder where the file should be
  EXPECT_EQ(readCached(path(), "key"), std::nullopt);
  EXPECT_FALSE(writeCached(path(), "key", "content"));
  EXPECT_EQ(readCached(path(), "key"), std::nullopt);
  EXPECT_FALSE(writeCached(path() / "deeper" / std::string(300, 'n'), "key", "content"));

  writeFileAtomically(folder_ / "plain", "a file where the folder should be");
  EXPECT_FALSE(writeCached(folder_ / "plain" / "file", "key", "content"));
  EXPECT_EQ(readCached(folder_ / "plain" / "file", "key"), std::nullopt);

  const auto fifo = folder_ / "fifo";  // reading it would wait forever
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(readCached(fifo, "key"), std::nullopt);
  const auto loop = folder_ / "loop";
  std::filesystem::create_symlink(loop, loop);
  EXPECT_EQ(readCached(loop, "key"), std::nullopt);
}

}  // namespace
}  // namespace oitlab
