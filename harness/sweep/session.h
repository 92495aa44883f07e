#pragma once

#include "measure/clock_probe.h"
#include "sweep/last_scene.h"

namespace oitlab {

/// A device that is open, with what is kept on it from group to group. A lost device takes all of
/// it along: then a new session is opened.
struct Session {
  explicit Session(const Device::Options& options) : device(options), scene(device) {
    // A CPU's clock is not the program's to see: its threads compete with all others.
    if (device.info().isCpu()) return;
    probe.emplace(device);
    probe->fit();
    clock.emplace([this] { return probe->run(); });
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  ClockWatch* clockWatch() { return clock ? &*clock : nullptr; }

  Device device;
  LastScene scene;
  // One for all groups, which share what is known of the clock.
  std::optional<ClockProbe> probe;
  std::optional<ClockWatch> clock;
};

}  // namespace oitlab
