// Two runs on one device notice each other.
#include "sweep/device_claim.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <string>

namespace oitlab::testing {
namespace {

std::string ownName(const std::string& name) {
  return name + " of process " + std::to_string(getpid());
}

TEST(DeviceClaims, ADeviceIsMarkedByOne) {
  auto first = std::make_unique<DeviceClaim>(ownName("device"));
  DeviceClaim second(ownName("device")), other(ownName("other device"));
  EXPECT_TRUE(first->take());
  EXPECT_TRUE(first->take()) << "it has it already";
  EXPECT_FALSE(second.take());
  EXPECT_TRUE(other.take());
  first.reset();
  EXPECT_TRUE(second.take());
}

TEST(DeviceClaims, AKilledProcessLeavesNoMark) {
  DeviceClaim mine(ownName("device of a child"));
  int ready[2] = {};
  ASSERT_EQ(pipe(ready), 0);
  const std::string name = ownName("device of a child");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    DeviceClaim claim(name);
    const char taken = claim.take() ? 'y' : 'n';
    if (write(ready[1], &taken, 1) != 1) _exit(1);
    for (;;) pause();
  }
  char taken = 0;
  ASSERT_EQ(read(ready[0], &taken, 1), 1);
  EXPECT_EQ(taken, 'y');
  EXPECT_FALSE(mine.take());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(mine.take());
  close(ready[0]);
  close(ready[1]);
}

}  // namespace
}  // namespace oitlab::testing
