// The smallest possible method, as methods/README.md describes it. A test adds it to the program.
#include "method/one_pass_method.h"
#include "sum_of_layers/sum_types.h"

namespace oitlab::sum_of_layers {

class SumOfLayers : public OnePassMethod {
 public:
  explicit SumOfLayers(const MethodContext& context)
      : OnePassMethod(
            context,
            {.file = "sum_of_layers/sum.glsl",
             .access = Access::blended,
             .sums = {{vk::Format::eR32G32B32A32Sfloat, glm::vec4(0), COMBINE_ADD, "light"}},
             .needsId = false}),
        strength_(float(context.parameters.real("strength"))) {}

  void record(const Frame& frame) override {
    recordPass(frame, "sum", SumPush{.frame = 0, .strength = strength_});
  }

 private:
  float strength_;
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
