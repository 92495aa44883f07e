// Weighted blended OIT (McGuire and Bavoil 2013): one geometry pass and a composite, without
// sorting and lists. Weights that decrease with depth approximate the order.
#include "frame/frame_bindings.h"
#include "frame/sample_counter.h"
#include "method/method.h"
#include "wboit/wboit_types.h"

namespace oitlab::wboit {

class Wboit : public Method {
 public:
  explicit Wboit(const MethodContext& context)
      : accumulated_(makeImage(context, "accumulated", accumulationFormat(context.parameters))),
        revealage_(makeImage(context, "revealage", revealageFormat(context.parameters))),
        bindings_(context.device, context.scene, context.target,
                  std::array<const GpuImage*, 2>{&accumulated_, &revealage_}),
        accumulate_(makeAccumulate(context)),
        composite_(Pipeline::graphics(context.device,
                                      {.vertexShader = "common/fullscreen.vert",
                                       .fragmentShader = "wboit/composite.frag",
                                       .colorFormats = {vulkanFormat(context.target.format())},
                                       .depthFormat = Target::depthFormat,
                                       .depthTest = false,
                                       .blends = {premultipliedOver()}})),
        samples_(context.device),
        depthScale_(context.parameters.real("depth_scale")),
        paperRange_(rangeOf(context.parameters.choice("weight"))) {}

  void record(const Frame& frame) override {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    const WboitPush push = pushFor(frame);
    samples_.reset(frame);
    frame.stage("accumulate", [&] {
      for (const GpuImage* image : {&accumulated_, &revealage_})
        image->transition(frame.commands, Layout::eUndefined, Layout::eColorAttachmentOptimal,
                          Stage::eAllCommands, Access::eMemoryWrite, Stage::eColorAttachmentOutput,
                          Access::eColorAttachmentRead | Access::eColorAttachmentWrite);
      const std::array attachments = {clearedAttachment(accumulated_, {0.0f, 0.0f, 0.0f, 0.0f}),
                                      clearedAttachment(revealage_, {1.0f, 0.0f, 0.0f, 0.0f})};
      frame.renderDepthTested(attachments, [&] {
        samples_.count(frame, [&] {
          frame.bind(accumulate_, push);
          frame.drawTransparent();
        });
      });
    });
    frame.stage("composite", [&] {
      for (const GpuImage* image : {&accumulated_, &revealage_})
        image->transition(frame.commands, Layout::eColorAttachmentOptimal,
                          Layout::eShaderReadOnlyOptimal, Stage::eColorAttachmentOutput,
                          Access::eColorAttachmentWrite, Stage::eFragmentShader,
                          Access::eShaderRead);
      frame.renderOnTarget([&] {
        composite_.bind(frame.commands, bindings_.set());
        frame.drawFullscreen();
      });
    });
  }

  Status status() override { return {.counters = samples_.counters()}; }

 private:
  static GpuImage makeImage(const MethodContext& context, const char* name, vk::Format format) {
    using Usage = vk::ImageUsageFlagBits;
    const auto [width, height] = context.target.color().extent();
    return {context.device,
            context.memory,
            {name, format, width, height, 1, Usage::eColorAttachment | Usage::eSampled}};
  }

  Pipeline makeAccumulate(const MethodContext& context) const {
    const std::string& weight = context.parameters.choice("weight");
    const std::string equation = weight == "none" ? "0" : weight.substr(2);
    using Factor = vk::BlendFactor;
    return Pipeline::graphics(
        context.device,
        {.fragmentShader = "wboit/accumulate.frag",
         .defines = {{"WEIGHT", equation}},
         .colorFormats = {accumulated_.description().format, revealage_.description().format},
         .depthFormat = Target::depthFormat,
         .blends = {additive(), blending(Factor::eZero, Factor::eOneMinusSrcColor)}});
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
    return {frame.constants, scale, nearest, farthest};
  }

  GpuImage accumulated_, revealage_;
  FrameBindings bindings_;
  Pipeline accumulate_, composite_;
  SampleCounter samples_;
  double depthScale_;
  float paperRange_;
};

const RegisterMethod registered({
    .name = "wboit",
    .summary = "weighted blended: one pass, no sorting; exact for one layer, else an estimate",
    .source = "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency, JCGT 2:2",
    .exact = false,
    .parameters = {choice("weight", {"eq7", "eq8", "eq9", "eq10", "none"},
                          "weight function by its equation in the paper; none: all layers alike"),
                   real(
                       "depth_scale", 0.0, 0.0, 1e6,
                       "factor from scene units to the depths (to 200) of equations 7 to 9; 0: the "
                       "scene's farthest point is at 200"),
                   choice("accum_format", {"rgba16f", "rgba32f"}, "of the weighted sums"),
                   choice("reveal_format", {"r16f", "r8", "r32f"},
                          "of the product of (1 - alpha); the paper has r8 beside r16f")},
    .features = {"independentBlend"},
    .make = makeMethod<Wboit>,
});

}  // namespace oitlab::wboit
