// Weighted blended OIT (McGuire and Bavoil 2013): no sorting and no lists, one geometry pass and a
// composite. The order is approximated by weights that fall off with depth.
#include "frame/sample_counter.h"
#include "method/method.h"
#include "wboit/wboit_types.h"

namespace oitlab::wboit {

class Wboit : public Method {
 public:
  void prepare(const Device& device, const GpuScene& scene, const Target& target,
               const Parameters& parameters) override {
    using Usage = vk::ImageUsageFlagBits;
    const auto usage = Usage::eColorAttachment | Usage::eSampled;
    const auto [width, height] = target.color().extent();
    const vk::Format sum = parameters.choice("accum_format") == "rgba32f"
                               ? vk::Format::eR32G32B32A32Sfloat
                               : vk::Format::eR16G16B16A16Sfloat;
    accumulated_ = GpuImage(device, memory_, {"accumulated", sum, width, height, 1, usage});
    revealage_ = GpuImage(device, memory_,
                          {"revealage", revealageFormat(parameters), width, height, 1, usage});
    bindings_.emplace(device, scene, target,
                      std::array<const GpuImage*, 2>{&accumulated_, &revealage_});

    const std::string weight = parameters.choice("weight");
    const std::string equation = weight == "none" ? "0" : weight.substr(2);
    paperRange_ = rangeOf(weight);
    using Factor = vk::BlendFactor;
    accumulate_ = Pipeline::graphics(
        device,
        {.fragmentShader = "wboit/accumulate.frag",
         .defines = {{"WEIGHT", equation}},
         .colorFormats = {accumulated_.description().format, revealage_.description().format},
         .depthFormat = Target::depthFormat,
         .blends = {additive(), blending(Factor::eZero, Factor::eOneMinusSrcColor)}});
    composite_ = Pipeline::graphics(device, {.vertexShader = "common/fullscreen.vert",
                                             .fragmentShader = "wboit/composite.frag",
                                             .colorFormats = {vulkanFormat(target.format())},
                                             .depthFormat = Target::depthFormat,
                                             .depthTest = false,
                                             .blends = {premultipliedOver()}});
    samples_.emplace(device);
    depthScale_ = parameters.real("depth_scale");
    bounds_ = scene.scene().bounds;
  }

  void record(const Frame& frame) override {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    const WboitPush push = pushFor(frame);
    samples_->reset(frame);
    frame.stage("accumulate", [&] {
      for (const GpuImage* image : {&accumulated_, &revealage_})
        image->transition(frame.commands, Layout::eUndefined, Layout::eColorAttachmentOptimal,
                          Stage::eAllCommands, Access::eMemoryWrite, Stage::eColorAttachmentOutput,
                          Access::eColorAttachmentRead | Access::eColorAttachmentWrite);
      const std::array attachments = {clearedAttachment(accumulated_, {0.0f, 0.0f, 0.0f, 0.0f}),
                                      clearedAttachment(revealage_, {1.0f, 0.0f, 0.0f, 0.0f})};
      frame.renderDepthTested(attachments, [&] {
        samples_->count(frame, [&] {
          accumulate_.bind(frame.commands, frame.bindings);
          accumulate_.push(frame.commands, push);
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
        composite_.bind(frame.commands, bindings_->set());
        frame.commands.draw(3, 1, 0, 0);
      });
    });
  }

  Status status() override { return {.counters = samples_->counters()}; }

 private:
  static vk::Format revealageFormat(const Parameters& parameters) {
    const std::string& name = parameters.choice("reveal_format");
    return name == "r8"     ? vk::Format::eR8Unorm
           : name == "r32f" ? vk::Format::eR32Sfloat
                            : vk::Format::eR16Sfloat;
  }

  /// The depth, in the paper's units, up to which a weight falls: beyond 157, 99.9 and 263
  /// equations 7, 8 and 9 are clamped to 1e-2 (solved for it), and all that lies there weighs the
  /// same.
  static float rangeOf(const std::string& weight) {
    return weight == "eq7" ? 150.0f : weight == "eq8" ? 95.0f : 250.0f;
  }

  /// The depth range of the scene from this camera, and the scale that takes it to the paper's.
  WboitPush pushFor(const Frame& frame) const {
    const glm::vec3 forward = glm::normalize(frame.camera.target - frame.camera.eye);
    float nearest = std::numeric_limits<float>::max(), farthest = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 point = {corner & 1 ? bounds_.max.x : bounds_.min.x,
                               corner & 2 ? bounds_.max.y : bounds_.min.y,
                               corner & 4 ? bounds_.max.z : bounds_.min.z};
      const float depth = glm::dot(point - frame.camera.eye, forward);
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
    nearest = std::max(nearest, frame.camera.near);
    farthest = std::max(farthest, 1.001f * nearest);
    const float scale = depthScale_ > 0.0 ? float(depthScale_) : paperRange_ / farthest;
    return {frame.constants, scale, nearest, farthest};
  }

  GpuImage accumulated_, revealage_;
  std::optional<FrameBindings> bindings_;
  Pipeline accumulate_, composite_;
  std::optional<SampleCounter> samples_;
  double depthScale_ = 0;
  float paperRange_ = 0;
  Bounds bounds_;
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
    .make = [] { return std::make_unique<Wboit>(); },
});

}  // namespace oitlab::wboit
