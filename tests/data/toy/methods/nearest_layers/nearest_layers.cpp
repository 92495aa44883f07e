// A k-buffer, as methods/README.md describes it. A test adds it to the program.
#include "method/one_pass_method.h"

namespace oitlab::nearest_layers {

class NearestLayers : public OnePassMethod {
 public:
  explicit NearestLayers(const MethodContext& context)
      : OnePassMethod(context,
                      {.file = "nearest_layers/nearest.glsl",
                       .access = Access::exclusive,
                       .defines = {{"KEPT", std::to_string(context.parameters.integer("k"))}}}) {}

  void record(const Frame& frame) override { recordPass(frame, "nearest", FrameOnly{}); }
};

const RegisterMethod registered({
    .name = "nearest_layers",
    .summary = "a toy: the k nearest layers of each pixel, the rest dropped",
    .source = "methods/README.md",
    .exact = false,
    .parameters = {integer("k", 4, 1, 8, "layers that a pixel keeps", "fragments")},
    .takesFragments = true,
    .computeFirst = true,
    .make = makeMethod<NearestLayers>,
});

}  // namespace oitlab::nearest_layers
