// When a GPU's clock counts as settled, tested with simulated devices and simulated time.
#include "measure/clock_watch.h"

#include <gtest/gtest.h>

#include "util/random.h"

namespace oitlab::testing {
namespace {

constexpr double fullMs = 0.5;  // time of the probe at full clock

/// A device whose clock is a function `clock` of the time and of the seconds of load since it last
/// idled; 1 is the full clock. Only probes and pass() take time.
struct MadeUpDevice {
  std::function<double(double now, double loaded)> clock;
  double now = 0, loaded = 0;
  int probes = 0;
  ClockWatch watch{[this] { return probe(); }, {}, [this] { return now; }};

  std::optional<double> probe() {
    ++probes;
    const double ms = fullMs / clock(now, loaded);
    now += ms / 1000;
    loaded += ms / 1000;
    return ms;
  }
  void idle(double seconds) {
    now += seconds;
    loaded = 0;
  }
  /// The result of a settle(): its level, and its duration.
  std::pair<double, double> settle() {
    const double begin = now;
    const double level = watch.settle();
    return {level, now - begin};
  }
};

/// The clock of an NVIDIA H200: a fifth of the full clock for 20 ms after idling, then rising.
double governed(double, double loaded) {
  return std::clamp(0.2 + (loaded - 0.02) / 0.05, 0.2, 1.0);
}

TEST(ClockWatch, WaitsUntilARampIsOver) {
  MadeUpDevice device{[](double now, double) { return std::min(1.0, 0.2 + 2 * now); }};
  const auto [level, seconds] = device.settle();
  EXPECT_DOUBLE_EQ(level, fullMs);
  EXPECT_GE(seconds, 0.5);
  EXPECT_LT(seconds, 0.7);
  EXPECT_TRUE(device.watch.held());
}

TEST(ClockWatch, IsNotTakenInByALowClockThatStandsStillAtFirst) {
  MadeUpDevice device{[](double now, double) { return now < 0.48 ? 0.2 : 1.0; }};
  const auto [level, seconds] = device.settle();
  EXPECT_DOUBLE_EQ(level, fullMs);
  EXPECT_GE(seconds, 0.52) << "50 ms without a further rise";
}

TEST(ClockWatch, ADeviceThatIdledIsUnderLoadUntilItsClockIsFullAgain) {
  MadeUpDevice device{governed};
  device.settle();
  device.idle(2);
  const auto [level, seconds] = device.settle();
  EXPECT_NEAR(level, fullMs, 0.03 * fullMs);
  EXPECT_GE(seconds, 0.05);
  EXPECT_LT(seconds, 0.1);
}

TEST(ClockWatch, AfterIdlingAClockThatLooksFullIsNotBelievedAtOnce) {
  // The device notices late that it has idled.
  MadeUpDevice device{
      [](double, double loaded) { return loaded < 0.01 || loaded > 0.04 ? 1.0 : 0.2; }};
  device.settle();
  device.idle(0.1);
  EXPECT_GE(device.settle().second, 0.05);
  EXPECT_TRUE(device.watch.held());
}

TEST(ClockWatch, ADeviceThatDidNotIdleIsNotHeldUp) {
  MadeUpDevice device{governed};
  device.settle();
  const int before = device.probes;
  const auto [level, seconds] = device.settle();
  EXPECT_DOUBLE_EQ(level, fullMs);
  EXPECT_EQ(device.probes - before, 5);
  EXPECT_LT(seconds, 0.003);
}

TEST(ClockWatch, SteadyNoiseSettlesAndHolds) {
  Pcg32 random(1);
  MadeUpDevice device{[&](double, double) { return random.uniform(0.98f, 1.0f); }};
  for (int block = 0; block < 100; ++block) {
    const auto [level, seconds] = device.settle();
    EXPECT_LT(seconds, block == 0 ? 0.6 : 0.12);
    EXPECT_TRUE(device.watch.isFull(level));
    device.idle(0.05);
    EXPECT_TRUE(device.watch.held());
  }
}

TEST(ClockWatch, OneTimeThatIsTooShortOrTooLongChangesNothing) {
  int probes = 0;
  MadeUpDevice device{[&](double, double) {
    ++probes;
    return probes == 100 ? 10.0 : probes == 1250 ? 0.1 : 1.0;
  }};
  EXPECT_DOUBLE_EQ(device.settle().first, fullMs);
  EXPECT_DOUBLE_EQ(device.watch.bestMs(), fullMs);
  probes = 1249;
  EXPECT_TRUE(device.watch.held());
}

TEST(ClockWatch, AClockThatNeverSettlesEndsAtTheLimit) {
  MadeUpDevice device{[](double now, double) { return std::exp(-now); }};
  device.settle();
  for (int block = 0; block < 3; ++block) {
    device.idle(0.1);
    const auto [level, seconds] = device.settle();
    EXPECT_GE(seconds, 1.0);
    EXPECT_LT(seconds, 1.1);
    EXPECT_FALSE(device.watch.isFull(level));
    device.idle(0.1);
    EXPECT_FALSE(device.watch.held());
  }
}

TEST(ClockWatch, ADeviceThatThrottlesIsWaitedForOnceAndIsNotCalledFull) {
  double now = 1;
  MadeUpDevice device{[&](double, double) { return now; }};
  device.settle();
  now = 0.85;
  EXPECT_FALSE(device.watch.held()) << "the block in which it began";
  auto [level, seconds] = device.settle();
  EXPECT_GE(seconds, 1.0) << "it may come back";
  EXPECT_FALSE(device.watch.isFull(level));
  EXPECT_TRUE(device.watch.held()) << "slow, but steady";
  std::tie(level, seconds) = device.settle();
  EXPECT_LT(seconds, 0.1);
  EXPECT_FALSE(device.watch.isFull(level));

  now = 1;
  EXPECT_FALSE(device.watch.held()) << "quicker is another clock too";
  std::tie(level, seconds) = device.settle();
  EXPECT_LT(seconds, 0.1);
  EXPECT_TRUE(device.watch.isFull(level));
  now = 0.85;
  EXPECT_GE(device.settle().second, 1.0) << "full is what is waited for again";
}

TEST(ClockWatch, WithoutUsableTimestampsNothingHolds) {
  double now = 0;
  ClockWatch watch([&]() -> std::optional<double> { return now += 0.01, std::nullopt; }, {},
                   [&] { return now; });
  EXPECT_TRUE(std::isnan(watch.settle()));
  EXPECT_FALSE(watch.isFull(watch.settle()));
  EXPECT_FALSE(watch.held());
}

TEST(ClockWatch, ProbesThatTakeLongStillMakeALevel) {
  MadeUpDevice device{[](double, double) { return fullMs / 400; }};
  const auto [level, seconds] = device.settle();
  EXPECT_NEAR(level, 400, 1e-9);
  EXPECT_LT(seconds, 1.5);
}

}  // namespace
}  // namespace oitlab::testing
