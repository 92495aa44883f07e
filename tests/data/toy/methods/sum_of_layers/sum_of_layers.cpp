// The smallest method there is: what methods/README.md describes, and no more. A test adds it.
#include "frame/sample_counter.h"
#include "method/method.h"
#include "sum_of_layers/sum_types.h"

namespace oitlab::sum_of_layers {

class SumOfLayers : public Method {
 public:
  void prepare(const Device& device, const GpuScene&, const Target& target,
               const Parameters& parameters) override {
    pipeline_ = Pipeline::graphics(device, {.fragmentShader = "sum_of_layers/sum.frag",
                                            .colorFormats = {vulkanFormat(target.format())},
                                            .depthFormat = Target::depthFormat,
                                            .blends = {additive()}});
    strength_ = float(parameters.real("strength"));
    samples_.emplace(device);
  }

  void record(const Frame& frame) override {
    samples_->reset(frame);
    frame.stage("sum", [&] {
      frame.renderOnTarget([&] {
        samples_->count(frame, [&] {
          pipeline_.bind(frame.commands, frame.bindings);
          pipeline_.push(frame.commands, SumPush{frame.constants, strength_});
          frame.drawTransparent();
        });
      });
    });
  }

  Status status() override { return {.counters = samples_->counters()}; }

 private:
  float strength_ = 0;
  Pipeline pipeline_;
  std::optional<SampleCounter> samples_;
};

const RegisterMethod registered({
    .name = "sum_of_layers",
    .summary = "a toy: light adds up, whatever is in front",
    .source = "methods/README.md",
    .exact = false,
    .parameters = {real("strength", 1.0, 0.0, 4.0, "factor of each layer")},
    .make = [] { return std::make_unique<SumOfLayers>(); },
});

}  // namespace oitlab::sum_of_layers
