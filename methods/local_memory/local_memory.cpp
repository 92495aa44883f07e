// Figure 3 of Knowles et al. 2013 as an experiment: what it costs to have local memory in a shader,
// used or not. Not a way to draw transparency: it adds nothing to the opaque image, many times.
#include "local_memory/local_memory_types.h"

#include "method/method.h"

namespace oitlab::local_memory {
namespace {

class LocalMemory : public Method {
 public:
  void prepare(const Device& device, const GpuScene&, const Target& target,
               const Parameters& parameters) override {
    passes_ = std::uint32_t(parameters.integer("passes"));
    const std::int64_t size = parameters.integer("size");
    pipeline_ = Pipeline::graphics(
        device, {.vertexShader = "common/fullscreen.vert",
                 .fragmentShader = "local_memory/local_memory.frag",
                 .defines = {{"SIZE", fmt::format("{}", size)}},
                 .colorFormats = {vulkanFormat(target.format())},
                 .depthFormat = Target::depthFormat,
                 .depthTest = false,
                 .blends = {additive()},
                 .ifRefused = fmt::format("an invocation has an array of {} bytes, which may be "
                                          "more than the driver allows: lower 'size'",
                                          16 * size)});
  }

  void record(const Frame& frame) override {
    frame.stage("fill", [&] {
      frame.renderOnTarget([&] {
        pipeline_.bind(frame.commands, frame.bindings);
        pipeline_.push(frame.commands, Push{frame.constants, 0});
        for (std::uint32_t pass = 0; pass < passes_; ++pass) frame.drawFullscreen();
      });
    });
  }

  Status status() override { return {}; }

 private:
  std::uint32_t passes_ = 0;
  Pipeline pipeline_;
};

const RegisterMethod registered({
    .name = "local_memory",
    .summary = "no method but an experiment: the cost of local memory in a shader (BMA, figure 3)",
    .source = "Knowles, Leach, Zambetta 2013, Backwards Memory Allocation and Improved OIT",
    .exact = false,
    .parameters = {integer("size", 64, 1, 1024, "length of the array of vec4", "of 16 bytes"),
                   integer("passes", 64, 1, 1024, "full-screen passes a frame")},
    .make = [] { return std::make_unique<LocalMemory>(); },
});

}  // namespace
}  // namespace oitlab::local_memory
