// Figure 3 of Knowles et al. 2013 as an experiment: the cost of local memory in a shader, whether
// or not it is used. It does not draw transparency: it adds zero to the opaque image many times.
#include "local_memory/local_memory_types.h"

#include "method/method.h"

namespace oitlab::local_memory {
namespace {

class LocalMemory : public Method {
 public:
  explicit LocalMemory(const MethodContext& context)
      : passes_(std::uint32_t(context.parameters.integer("passes"))),
        pipeline_(makePipeline(context)) {}

  void record(const Frame& frame) override {
    frame.stage("fill", [&] {
      frame.renderOnTarget([&] {
        frame.bind(pipeline_, Push{frame.constants, 0});
        for (std::uint32_t pass = 0; pass < passes_; ++pass) frame.drawFullscreen();
      });
    });
  }

  Status status() override { return {}; }

 private:
  static Pipeline makePipeline(const MethodContext& context) {
    const std::int64_t size = context.parameters.integer("size");
    return Pipeline::graphics(
        context.device,
        {.vertexShader = "common/fullscreen.vert",
         .fragmentShader = "local_memory/local_memory.frag",
         .defines = {{"SIZE", fmt::format("{}", size)}},
         .colorFormats = {vulkanFormat(context.target.format())},
         .depthFormat = Target::depthFormat,
         .depthTest = false,
         .blends = {additive()},
         .ifRefused = fmt::format("an invocation has an array of {} bytes, which may be more than "
                                  "the driver allows: lower 'size'",
                                  16 * size)});
  }

  std::uint32_t passes_;
  Pipeline pipeline_;
};

const RegisterMethod registered({
    .name = "local_memory",
    .summary = "no method but an experiment: the cost of local memory in a shader (BMA, figure 3)",
    .source = "Knowles, Leach, Zambetta 2013, Backwards Memory Allocation and Improved OIT",
    .exact = false,
    .parameters = {integer("size", 64, 1, 1024, "length of the array of vec4", "of 16 bytes"),
                   integer("passes", 64, 1, 1024, "full-screen passes a frame")},
    .make = makeMethod<LocalMemory>,
});

}  // namespace
}  // namespace oitlab::local_memory
