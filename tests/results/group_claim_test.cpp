// Claims on groups: one process at a time, cells all at once or not at all, whoever is killed when.
#include "results/group_claim.h"

#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include <gmock/gmock.h>

#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr int cellCount = 5;

Image small() {
  return {.width = 2, .height = 2, .rgba = std::vector<float>(16, 0.5f)};
}

class Claims : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    for (const char* kind : {"cells", "images"}) fs::create_directory(folder_ / kind);
  }

  std::unique_ptr<GroupClaim> take(GroupClaim::Terms terms = {}) {
    return GroupClaim::take(folder_, "key", holder_, terms);
  }

  static void writeAll(GroupClaim& claim) {
    for (int i = 0; i < cellCount; ++i) {
      const std::string id = fmt::format("cell{}", i);
      claim.writeImage(id + ".png", small());
      claim.writeCell(id, {{"token", claim.token()}});
    }
  }

  /// The tokens in the cells that are there, one for each cell.
  std::multiset<std::string> tokens() const {
    std::multiset<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_ / "cells")) {
      found.insert(readJsonFile(entry.path()).at("token"));
      EXPECT_TRUE(fs::exists(folder_ / "images" / entry.path().stem().concat(".png")));
    }
    return found;
  }

  /// In a process of its own, which ends without a word, as by SIGKILL.
  template <typename Work>
  static pid_t fork(Work&& work) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    // An exception must not reach GoogleTest, which would go on with the other tests in this copy
    // of the process, where no thread of the Vulkan driver lives.
    try {
      work();
    } catch (const std::exception& error) {
      fmt::print(stderr, "in the child: {}\n", error.what());
      ::_exit(2);
    }
    ::_exit(0);
  }

  static void waitFor(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
  }

  std::string holder_;
};

TEST_F(Claims, OneAtATime) {
  auto first = take();
  ASSERT_TRUE(first);
  EXPECT_FALSE(take());
  EXPECT_THAT(holder_, HasSubstr(fmt::format("process {} on ", getpid())));
  EXPECT_TRUE(GroupClaim::take(folder_, "another", holder_));
  first.reset();
  EXPECT_TRUE(take());
}

TEST_F(Claims, NothingAppearsBeforeTheCommitAndAllWithIt) {
  auto claim = take();
  writeAll(*claim);
  EXPECT_TRUE(tokens().empty());
  EXPECT_TRUE(claim->commit());
  EXPECT_EQ(tokens().count(claim->token()), std::size_t(cellCount));
  claim.reset();
  EXPECT_THAT(filesInFolder(), ::testing::UnorderedElementsAre("cells", "images"));
}

TEST_F(Claims, WithoutACommitNothingIsLeft) {
  writeAll(*take());
  EXPECT_TRUE(tokens().empty());
  EXPECT_THAT(filesInFolder(), ::testing::UnorderedElementsAre("cells", "images"));
}

TEST_F(Claims, ThatOfADeadProcessIsTakenOverAtOnce) {
  waitFor(fork([&] {
    auto claim = take();
    writeAll(*claim);
    ::_exit(0);
  }));
  ASSERT_TRUE(fs::exists(folder_ / "running" / "key"));
  EXPECT_TRUE(take());
  EXPECT_TRUE(tokens().empty());
}

TEST_F(Claims, AStaleOneIsTakenOverAndItsOwnerCommitsNothing) {
  // Never a heartbeat: the owner stands still (a laptop that sleeps, a machine that is cut off).
  auto still = take({.lease = 60s, .heartbeat = 60s});
  writeAll(*still);
  std::this_thread::sleep_for(300ms);
  auto next = take({.lease = 100ms, .heartbeat = 60s});
  ASSERT_TRUE(next);
  EXPECT_FALSE(still->isHeld());
  EXPECT_FALSE(still->commit());
  still.reset();
  EXPECT_TRUE(next->isHeld());
  writeAll(*next);
  EXPECT_TRUE(next->commit());
  EXPECT_EQ(tokens().count(next->token()), std::size_t(cellCount));
}

/// The owner file of the only claim.
fs::path ownerFile(const fs::path& results) {
  for (const auto& entry : fs::directory_iterator(results / "running" / "key"))
    if (entry.path().extension() == ".owner") return entry.path();
  ADD_FAILURE() << "no owner";
  return {};
}

TEST_F(Claims, OneFromBeforeTheClockWasSetBackIsTakenOver) {
  const auto still = take({.lease = 60s, .heartbeat = 60s});
  const fs::path owner = ownerFile(folder_);
  fs::last_write_time(owner, fs::last_write_time(owner) + 30s);
  EXPECT_FALSE(take());  // clocks of machines differ by less than a lease
  fs::last_write_time(owner, fs::last_write_time(owner) + 1h);
  EXPECT_TRUE(take());
  EXPECT_FALSE(still->isHeld());
}

TEST_F(Claims, AnOwnerThatIsHalfWrittenIsSomebodyUntilTheLeaseEnds) {
  const auto still = take({.lease = 60s, .heartbeat = 60s});
  std::ofstream(ownerFile(folder_)) << "{\"token\": \"x";
  EXPECT_FALSE(take());
  EXPECT_EQ(holder_, "another process");
  std::this_thread::sleep_for(300ms);
  EXPECT_TRUE(take({.lease = 100ms, .heartbeat = 60s}));
}

TEST_F(Claims, AHeartbeatKeepsIt) {
  const auto claim = take({.lease = 60s, .heartbeat = 50ms});
  std::this_thread::sleep_for(1s);
  EXPECT_FALSE(take({.lease = 500ms, .heartbeat = 60s}));
  finishCommits(folder_, {.lease = 500ms, .heartbeat = 60s});
  EXPECT_TRUE(claim->isHeld());
}

TEST_F(Claims, ACommitThatWasCutShortIsFinished) {
  const fs::path done = folder_ / "running" / "key.0123456789abcdef.done";
  fs::create_directories(done / "cells");
  fs::create_directories(done / "images");
  // Some files were moved: those are in their places.
  writeJsonFile(folder_ / "cells" / "cell0.json", {{"token", "new"}});
  writeJsonFile(folder_ / "cells" / "cell1.json", {{"token", "old"}});
  writeJsonFile(done / "cells" / "cell1.json", {{"token", "new"}});
  for (int i = 0; i < 2; ++i)
    writeImage(folder_ / "images" / fmt::format("cell{}.png", i), small());
  finishCommits(folder_);
  EXPECT_EQ(tokens().count("new"), 2u);
  EXPECT_THAT(filesInFolder(), ::testing::UnorderedElementsAre("cells", "images"));
}

TEST_F(Claims, KilledAtAnyMomentTheCellsAreThoseOfOneCommit) {
  std::srand(1);
  int changes = 0;
  std::string before;
  for (int round = 0; round < 40; ++round) {
    const pid_t child = fork([&] {
      for (;;) {
        auto claim = take();
        if (!claim) ::_exit(1);
        writeAll(*claim);
        claim->commit();
      }
    });
    std::this_thread::sleep_for(std::chrono::microseconds(std::rand() % 30'000));
    ::kill(child, SIGKILL);
    waitFor(child);
    finishCommits(folder_);
    const auto found = tokens();
    ASSERT_TRUE(found.empty() || (found.size() == cellCount &&
                                  found.count(*found.begin()) == std::size_t(cellCount)))
        << "round " << round;
    if (!found.empty()) changes += *found.begin() != std::exchange(before, *found.begin());
  }
  EXPECT_GT(changes, 5) << "too few commits: nothing was tested";
}

TEST_F(Claims, TwoProcessesNeverHoldOneGroupTogether) {
  const auto work = [&] {
    for (int i = 0; i < 60; ++i) {
      std::string other;
      const auto claim = GroupClaim::take(folder_, "key", other);
      if (!claim) continue;
      if (!fs::create_directory(folder_ / "inside")) ::_exit(1);
      fs::remove(folder_ / "inside");
    }
    ::_exit(0);
  };
  std::vector<pid_t> children;
  children.reserve(4);
  for (int i = 0; i < 4; ++i) children.push_back(fork(work));
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
}

TEST_F(Claims, AFolderThatIsGoneIsAnOutputError) {
  auto claim = take();
  fs::remove_all(folder_);
  EXPECT_THROW(claim->writeCell("cell0", {{"a", 1}}), OutputError);
  EXPECT_THROW(claim->writeImage("cell0.png", small()), OutputError);
}

}  // namespace
}  // namespace oitlab
