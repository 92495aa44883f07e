#pragma once

namespace oitlab {

/// Thrown where work stops because of a signal. No std::exception: what catches failures of a cell
/// must not catch this.
struct Interrupted {
  int signal;
};

/// While it lives, the first SIGINT or SIGTERM is only noted, so that what is in progress can be
/// left in order. A second one ends the program at once, as without this. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

/// The signal that was noted, or 0.
int notedSignal();

/// Throws Interrupted when a signal was noted. To be called often where work takes long.
void checkInterrupt();

}  // namespace oitlab
