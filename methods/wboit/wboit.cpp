// Weighted blended OIT (McGuire and Bavoil 2013): one geometry pass and a composite, without
// sorting and lists. Weights that decrease with depth approximate the order.
#include "method/one_pass_method.h"
#include "wboit/wboit_types.h"

namespace oitlab::wboit {

class Wboit : public OnePassMethod {
 public:
  explicit Wboit(const MethodContext& context)
      : OnePassMethod(context, program(context.parameters)),
        depthScale_(context.parameters.real("depth_scale")),
        paperRange_(rangeOf(context.parameters.choice("weight"))) {}

  void record(const Frame& frame) override { recordPass(frame, "accumulate", pushFor(frame)); }

 private:
  static FragmentProgram program(const Parameters& parameters) {
    const std::string& weight = parameters.choice("weight");
    return {.file = "wboit/wboit.glsl",
            .access = Access::blended,
            .defines = {{"WEIGHT", weight == "none" ? "0" : weight.substr(2)}},
            .sums = {{accumulationFormat(parameters), glm::vec4(0), COMBINE_ADD, "accumulated"},
                     {revealageFormat(parameters), glm::vec4(1, 0, 0, 0), COMBINE_ATTENUATE,
                      "revealage"}},
            .needsId = false};
  }

  static vk::Format accumulationFormat(const Parameters& parameters) {
    return parameters.choice("accum_format") == "rgba32f" ? vk::Format::eR32G32B32A32Sfloat
                                                          : vk::Format::eR16G16B16A16Sfloat;
  }

  static vk::Format revealageFormat(const Parameters& parameters) {
    const std::string& name = parameters.choice("reveal_format");
    return name == "r8"     ? vk::Format::eR8Unorm
           : name == "r32f" ? vk::Format::eR32Sfloat
                            : vk::Format::eR16Sfloat;
  }

  /// The depth, in the paper's units, up to which a weight decreases. Beyond the depths 157, 99.9
  /// and 263, equations 7, 8 and 9 are clamped to 1e-2, so that all weights there are equal.
  static float rangeOf(const std::string& weight) {
    return weight == "eq7" ? 150.0f : weight == "eq8" ? 95.0f : 250.0f;
  }

  /// The depth range of the scene for this camera, and the scale to the paper's units.
  WboitPush pushFor(const Frame& frame) const {
    const auto [nearest, farthest] = depthRange(frame.camera, frame.scene.scene().bounds);
    const float scale = depthScale_ > 0.0 ? float(depthScale_) : paperRange_ / farthest;
    return {frame.constants, 1.0f / scale, nearest, farthest};
  }

  double depthScale_;
  float paperRange_;
};

const RegisterMethod registered({
    .name = "wboit",
    .summary = "weighted blended: one pass, no sorting; exact for one layer, else an estimate",
    .source = "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency, JCGT 2:2",
    .exact = false,
    .parameters =
        {choice("weight", {"eq7", "eq8", "eq9", "eq10", "none"},
                "weight function by its equation in the paper; none: all layers alike"),
         real("depth_scale", 0.0, 0.0, 1e6,
              "factor from scene units to the depths (to 200) of equations 7 to 9; 0: the "
              "scene's farthest point is at 200"),
         choice("accum_format", {"rgba16f", "rgba32f"},
                "of the weighted sums; source=compute has them in registers, as float32"),
         choice("reveal_format", {"r16f", "r8", "r32f"},
                "of the product of (1 - alpha); the paper has r8 beside r16f; as accum_format")},
    .takesFragments = true,
    .make = makeMethod<Wboit>,
});

}  // namespace oitlab::wboit
