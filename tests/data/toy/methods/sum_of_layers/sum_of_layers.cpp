// The smallest possible method, as methods/README.md describes it. A test adds it to the program.
#include "frame/sample_counter.h"
#include "method/method.h"
#include "sum_of_layers/sum_types.h"

namespace oitlab::sum_of_layers {

class SumOfLayers : public Method {
 public:
  explicit SumOfLayers(const MethodContext& context)
      : strength_(float(context.parameters.real("strength"))),
        pipeline_(Pipeline::graphics(context.device,
                                     {.fragmentShader = "sum_of_layers/sum.frag",
                                      .colorFormats = {vulkanFormat(context.target.format())},
                                      .depthFormat = Target::depthFormat,
                                      .blends = {additive()}})),
        samples_(context.device) {}

  void record(const Frame& frame) override {
    samples_.reset(frame);
    frame.stage("sum", [&] {
      frame.renderOnTarget([&] {
        samples_.count(frame, [&] {
          frame.bind(pipeline_, SumPush{frame.constants, strength_});
          frame.drawTransparent();
        });
      });
    });
  }

  Status status() override { return {.counters = samples_.counters()}; }

 private:
  float strength_;
  Pipeline pipeline_;
  SampleCounter samples_;
};

const RegisterMethod registered({
    .name = "sum_of_layers",
    .summary = "a toy: light adds up, whatever is in front",
    .source = "methods/README.md",
    .exact = false,
    .parameters = {real("strength", 1.0, 0.0, 4.0, "factor of each layer")},
    .make = makeMethod<SumOfLayers>,
});

}  // namespace oitlab::sum_of_layers
