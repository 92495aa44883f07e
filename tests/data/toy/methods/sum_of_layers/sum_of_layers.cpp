// The smallest possible method, as methods/README.md describes it. A test adds it to the program.
#include "method/make_source.h"
#include "sum_of_layers/sum_types.h"

namespace oitlab::sum_of_layers {

class SumOfLayers : public Method {
 public:
  explicit SumOfLayers(const MethodContext& context)
      : strength_(float(context.parameters.real("strength"))),
        source_(makeSource(context)),
        pass_(source_->make(
            {.file = "sum_of_layers/sum.glsl",
             .access = Access::blended,
             .sums = {{vk::Format::eR32G32B32A32Sfloat, glm::vec4(0), COMBINE_ADD, "light"}},
             .needsId = false})) {}

  bool finishesTarget() const override { return source_->finishesTarget(); }

  void record(const Frame& frame) override {
    source_->run(frame, "sum", pass_, SumPush{source_->begin(frame), strength_});
    source_->end(frame);
  }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    Status status;
    source_->addCounters(status.counters);
    return status;
  }

 private:
  float strength_;
  std::unique_ptr<FragmentSource> source_;
  FragmentPass pass_;
};

const RegisterMethod registered({
    .name = "sum_of_layers",
    .summary = "a toy: light adds up, whatever is in front",
    .source = "methods/README.md",
    .exact = false,
    .parameters = {real("strength", 1.0, 0.0, 4.0, "factor of each layer")},
    .takesFragments = true,
    .make = makeMethod<SumOfLayers>,
});

}  // namespace oitlab::sum_of_layers
