#include "util/interrupt.h"

#include <csignal>
#include <initializer_list>

namespace oitlab {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int signal) {
  noted = signal;
  // Both, so that SIGTERM followed by SIGINT is as immediate as two of one kind.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  noted = 0;
  // What the parent had ignored (nohup, a background job of a script) stays ignored.
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, note) == SIG_IGN) std::signal(signal, SIG_IGN);
}

InterruptGuard::~InterruptGuard() {
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

int notedSignal() {
  return noted;
}

void checkInterrupt() {
  if (const int signal = noted; signal != 0) throw Interrupted{signal};
}

}  // namespace oitlab
