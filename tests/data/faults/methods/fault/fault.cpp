// A method that draws nothing and goes wrong as it is told: what a run makes of failures is tested
// with it. The environment variable OITLAB_FAULT, where it is set, says how in place of the
// parameter: so that what failed in one run works in the next.
#include <cstdlib>
#include <new>
#include <thread>

#include "method/method.h"
#include "util/error.h"

namespace oitlab::fault {

class Fault : public Method {
 public:
  explicit Fault(const MethodContext& context) {
    const char* variable = std::getenv("OITLAB_FAULT");
    kind_ = variable ? variable : context.parameters.choice("kind");
    if (kind_ == "prepare") throw DeviceError("it cannot be made ready");
    if (kind_ == "memory") throw std::bad_alloc();
  }

  void record(const Frame& frame) override {
    static int frames = 0;
    ++frames;
    if (kind_ == "frame") throw DeviceError("a frame failed");
    if (kind_ == "memory_later" && frames > 5) throw std::bad_alloc();
    if (kind_ == "lost" || (kind_ == "lost_once" && frames == 5))
      throw DeviceLost("the device is lost");
    if (kind_ == "stuck") std::this_thread::sleep_for(std::chrono::minutes(1));
    // A viewport of no width is against the rules of Vulkan, and does no harm.
    if (kind_ == "invalid") frame.commands.setViewport(0, vk::Viewport(0, 0, 0, 1, 0, 1));
    frame.stage("nothing", [] {});
  }

  Status status() override { return {.counters = {{"fragments", 1}}}; }

 private:
  std::string kind_;
};

const RegisterMethod registered({
    .name = "fault",
    .summary = "for tests: goes wrong as it is told",
    .source = "tests/python/cli/test_faults.py",
    .exact = false,
    .parameters = {choice("kind",
                          {"none", "prepare", "frame", "memory", "memory_later", "lost",
                           "lost_once", "stuck", "invalid"},
                          "what goes wrong")},
    .make = makeMethod<Fault>,
});

}  // namespace oitlab::fault
