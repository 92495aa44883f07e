// The A-buffer of Knowles, Leach and Zambetta 2013, "Backwards Memory Allocation and Improved OIT":
// every fragment in per-pixel linked lists, sorted in local memory. With backwards memory
// allocation (BMA) pixels are grouped by their number of fragments in intervals of powers of two,
// and each interval has a shader with as much local memory as it needs.
//
//   options      what the parameters mean: intervals, and the variant of the sort for each
//   list_memory  the buffers
//   sort_passes  masks and sorts
//
// Pixels beyond max_fragments (and, where the stencil counts, beyond what it can) are sorted in
// their lists, so that the image is exact whatever the parameters, but for those that say
// otherwise.
#include "abuffer/options.h"
#include "abuffer/sort_passes.h"
#include "method/make_source.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab::abuffer {
namespace {

using Stage = vk::PipelineStageFlagBits2;

class Abuffer : public Method {
 public:
  explicit Abuffer(const MethodContext& context)
      : device_(context.device),
        options_(context.parameters, device_.info(), formatName(context.target.format())),
        lists_(device_, context.memory, options_, context.target.pixels()),
        stencil_(makeStencil(context)),
        source_(makeSource(context)),
        isHardware_(isHardware(context.parameters)),
        sorts_(device_, options_, stencil_.extent().width > 0 ? &stencil_ : nullptr) {
    makeCapture();
    if (!options_.truncate) deep_ = Pipeline::compute(device_, "abuffer/deep.comp", options_.nodes);
    if (options_.byInterval())
      composite_ = Pipeline::compute(device_, "abuffer/composite.comp", options_.nodes);
    tally_ = Pipeline::compute(device_, "abuffer/tally.comp", options_.nodes);
  }

  bool usesComputeRasterizer() const override { return source_->usesComputeRasterizer(); }

  void record(const Frame& frame) override {
    counted_ = frame.instrumented;
    const std::uint64_t constants = source_->begin(frame);
    frame.stage("clear", [&] {
      lists_.clear(frame);
      frame.barrier(Stage::eTransfer, Stage::eFragmentShader | Stage::eComputeShader);
    });
    Push push = lists_.push(frame);
    push.frame = constants;
    capture(frame, push);
    sorts_.record(frame, lists_, push);
    const auto shaders = Stage::eFragmentShader | Stage::eComputeShader;
    frame.barrier(shaders, shaders | Stage::eDrawIndirect);
    if (rounds_ > 0) frame.stage("deep", [&] { sortDeep(frame, push); });
    if (options_.byInterval()) frame.stage("composite", [&] { pixels(frame, composite_, push); });
    if (frame.instrumented) frame.stage("tally", [&] { pixels(frame, tally_, push); });
    recordReadback(frame.commands, {&lists_.counters()}, shaders);
    source_->end(frame);
  }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    const Counters c = lists_.counters().read<Counters>();
    bool again = false;
    if (c.fragments > lists_.capacity() && !options_.drop) {
      lists_.growNodes(withSlack(c.fragments));
      again = true;
    }
    if (c.deepPixels > lists_.deepCapacity()) {
      lists_.growDeepList(withSlack(c.deepPixels));
      again = true;
    }
    if (c.deepPixels > 0 && rounds_ == 0) {
      rounds_ = 1;
      again = true;
    } else if (c.unfinished > 0) {
      rounds_ *= 2;
      again = true;
    }
    if (again) return {.recordAgain = true};
    if (c.broken > 0)
      fail<DeviceError>(
          "abuffer: the lists of {} pixels do not end as lists do, or {} does not carry out the "
          "shaders' loops in full (a pixel may be too deep for it)",
          c.broken, device_.info().name);
    Status status{.counters = countersOf(c)};
    source_->addCounters(status.counters);
    status.counters["fragments"] = c.fragments;
    return status;
  }

 private:
  /// An image without extent where the options need none.
  GpuImage makeStencil(const MethodContext& context) const {
    if (!options_.byInterval() || !options_.fragmentShader()) return {};
    using Aspect = vk::ImageAspectFlagBits;
    const vk::Format both = vk::Format::eD32SfloatS8Uint, alone = vk::Format::eS8Uint;
    const auto use = vk::FormatFeatureFlagBits::eDepthStencilAttachment;
    // A stencil that the capture counts in stands beside the depth that the capture is tested with,
    // the same 32-bit floats as the opaque depth.
    const vk::Format format = options_.stencilCounts()
                                  ? device_.supportedFormat({both}, use)
                                  : device_.supportedFormat({alone, both}, use);
    vk::ImageAspectFlags aspects = Aspect::eStencil;
    if (format == both) aspects |= Aspect::eDepth;
    return {device_,
            context.memory,
            {format == both ? "depth and stencil" : "stencil", format, context.target.width(),
             context.target.height(), 1, vk::ImageUsageFlagBits::eDepthStencilAttachment, aspects}};
  }

  void makeCapture() {
    FragmentProgram program{
        .file = "abuffer/capture.glsl", .access = Access::none, .defines = options_.nodes};
    if (options_.counts()) program.defines.emplace("COUNTS", "1");
    if (options_.stencilCounts()) {
      if (!isHardware_)
        fail<InputError>(
            "abuffer: mask=stencil_increment counts with the stencil of the hardware rasterizer; "
            "with source=compute take another mask");
      program.depthStencilFormat = stencil_.description().format;
      using Operation = vk::StencilOp;
      program.stencil = vk::StencilOpState(Operation::eKeep, Operation::eIncrementAndClamp,
                                           Operation::eKeep, vk::CompareOp::eAlways, 0xff, 0xff, 0);
      copyDepth_ = Pipeline::graphics(device_, {.vertexShader = "common/fullscreen.vert",
                                                .fragmentShader = "abuffer/copy_depth.frag",
                                                .depthFormat = program.depthStencilFormat,
                                                .depthWrite = true,
                                                .depthCompare = vk::CompareOp::eAlways,
                                                .stencilFormat = program.depthStencilFormat});
    }
    capture_ = source_->make(program);
  }

  void capture(const Frame& frame, const Push& push) {
    if (options_.stencilCounts()) frame.stage("copy depth", [&] { copyDepth(frame); });
    FragmentRun run;
    if (options_.stencilCounts()) run.depthStencil = &stencil_;
    source_->run(frame, "capture", capture_, push, run);
    const auto tests = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
    frame.barrier(source_->stages() | tests,
                  Stage::eFragmentShader | Stage::eComputeShader | tests);
  }

  void copyDepth(const Frame& frame) const {
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    const auto tests = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
    stencil_.transition(frame.commands, Layout::eUndefined, Layout::eDepthStencilAttachmentOptimal,
                        Stage::eAllCommands, Access::eMemoryWrite, tests,
                        Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite);
    frame.renderOnDepthStencil(stencil_, vk::AttachmentLoadOp::eClear, [&] {
      frame.bind(copyDepth_);
      frame.commands.setStencilReference(vk::StencilFaceFlagBits::eFrontAndBack, 0);
      frame.drawFullscreen();
    });
    frame.barrier(tests, tests);
  }

  void sortDeep(const Frame& frame, Push push) const {
    push.rounds = rounds_;
    for (push.round = 0; push.round < rounds_; ++push.round) {
      frame.bind(deep_, push);
      frame.commands.dispatchIndirect(lists_.counters().vk(), offsetof(Counters, deepGroups));
      frame.barrier(Stage::eComputeShader, Stage::eComputeShader | Stage::eTransfer);
    }
  }

  static void pixels(const Frame& frame, const Pipeline& pipeline, const Push& push) {
    frame.bind(pipeline, push);
    frame.dispatchPixels();
  }

  std::map<std::string, std::uint64_t> countersOf(const Counters& c) const {
    const std::uint64_t lost = c.fragments - std::min(c.fragments, lists_.capacity());
    std::map<std::string, std::uint64_t> counters = {
        {"fragments", c.fragments}, {"lost_fragments", lost}, {"deep_pixels", c.deepPixels}};
    if (!counted_) return counters;
    // Nothing is lost in silence, not even to a device that leaves loops early.
    if (std::uint64_t(c.blended) + c.truncatedFragments + lost != c.fragments)
      fail<DeviceError>(
          "abuffer: {} fragments were captured, {} blended, {} truncated and {} lost: {} does not "
          "carry out the shaders' loops in full (a pixel may be too deep for it)",
          c.fragments, c.blended, c.truncatedFragments, lost, device_.info().name);
    counters["blended_fragments"] = c.blended;
    counters["max_fragments_per_pixel"] = c.deepest;
    counters["covered_pixels"] = c.covered;
    counters["truncated_pixels"] = c.truncatedPixels;
    counters["truncated_fragments"] = c.truncatedFragments;
    for (std::uint32_t bin = 0; bin + 1 < BINS; ++bin)
      counters[fmt::format("pixels_{}", SMALLEST_INTERVAL << bin)] = c.pixels[bin];
    counters["pixels_more"] = c.pixels[BINS - 1];
    return counters;
  }

  const Device& device_;
  Options options_;
  ListMemory lists_;
  GpuImage stencil_;
  std::unique_ptr<FragmentSource> source_;
  bool isHardware_;
  SortPasses sorts_;
  FragmentPass capture_;
  Pipeline copyDepth_, deep_, composite_, tally_;
  std::uint32_t rounds_ = 0;  // dispatches that the sort of deep pixels is spread over
  bool counted_ = false;      // the last frame was an instrumented one
};

const RegisterMethod registered({
    .name = "abuffer",
    .summary = "exact: per-pixel linked lists, sorted in local memory; backwards memory allocation",
    .source = "Knowles, Leach, Zambetta 2013, Backwards Memory Allocation and Improved OIT",
    .exact = true,
    .parameters = declareParameters(),
    .features = {"fragmentStoresAndAtomics"},
    .takesFragments = true,
    .make = makeMethod<Abuffer>,
});

}  // namespace
}  // namespace oitlab::abuffer
