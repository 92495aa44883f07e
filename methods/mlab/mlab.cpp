// Multi-layer alpha blending (Salvi and Vaidyanathan 2014): a few nodes per pixel, into which
// fragments are blended as they come. One pass, bounded memory; what it gets wrong depends on the
// order.
#include "method/one_pass_method.h"

namespace oitlab::mlab {

class Mlab : public OnePassMethod {
 public:
  explicit Mlab(const MethodContext& context)
      : OnePassMethod(context, program(context.parameters)) {}

  void record(const Frame& frame) override { recordPass(frame, "blend", FrameOnly{}); }

 private:
  static FragmentProgram program(const Parameters& parameters) {
    const std::string& format = parameters.choice("node_format");
    return {.file = "mlab/mlab.glsl",
            .access = Access::exclusive,
            .defines = {{"NODES", std::to_string(parameters.integer("nodes")) + "u"},
                        {"NODE_BITS", format == "rgba8"     ? "8"
                                      : format == "rgba16f" ? "16"
                                                            : "32"},
                        {"LEAST_ERROR", parameters.choice("merge") == "least_error" ? "1" : "0"}}};
  }
};

const RegisterMethod registered({
    .name = "mlab",
    .summary = "multi-layer alpha blending: a few nodes per pixel, neighbors merged; exact for as "
               "many layers, else "
               "dependent on the order",
    .source = "Salvi and Vaidyanathan 2014, Multi-Layer Alpha Blending, I3D",
    .exact = false,
    .parameters =
        {integer("nodes", 4, 1, 16, "that a pixel has; the paper has 2 and 4", "nodes"),
         choice("merge", {"last", "least_error"},
                "which neighbors are merged when nodes run out: last: the two farthest, as in the "
                "paper; least_error: those whose back one is seen least"),
         choice("node_format", {"rgba16f", "rgba8", "rgba32f"},
                "of a node's color and transmittance, rounded at each merge; depth and id take 8 "
                "bytes more; the paper has rgba8")},
    .takesFragments = true,
    .computeFirst = true,
    .make = makeMethod<Mlab>,
});

}  // namespace oitlab::mlab
