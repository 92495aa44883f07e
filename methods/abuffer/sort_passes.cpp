#include "abuffer/sort_passes.h"

#include <cstddef>

namespace oitlab::abuffer {
namespace {

using Stage = vk::PipelineStageFlagBits2;
constexpr auto stencilTests = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;

/// What a full-screen pass with the stencil does, as a description of its pipeline.
Pipeline::Graphics fullscreen(const char* shader, const Defines& defines, const GpuImage& stencil,
                              vk::CompareOp compare, vk::StencilOp onPass,
                              const std::string& ifRefused = "") {
  const vk::Format format = stencil.description().format;
  const bool hasDepth(stencil.description().aspect & vk::ImageAspectFlagBits::eDepth);
  vk::StencilOpState state(vk::StencilOp::eKeep, onPass, vk::StencilOp::eKeep, compare);
  state.compareMask = state.writeMask = 0xff;
  return {.vertexShader = "common/fullscreen.vert",
          .fragmentShader = shader,
          .defines = defines,
          .depthFormat = hasDepth ? format : vk::Format::eUndefined,
          .depthTest = false,
          .stencilFormat = format,
          .stencil = state,
          .ifRefused = ifRefused};
}

}  // namespace

SortPasses::SortPasses(const Device& device, const Options& options, const GpuImage* stencil)
    : options_(options), stencil_(stencil) {
  for (const IntervalPlan& plan : options.intervals) {
    const std::string ifRefused = options.ifRefused(plan);
    if (!options.fragmentShader())
      sorts_.push_back(
          Pipeline::compute(device, "abuffer/resolve.comp", plan.defines, {}, 0, ifRefused));
    else if (!options.byInterval())
      sorts_.push_back(Pipeline::graphics(device, {.vertexShader = "common/fullscreen.vert",
                                                   .fragmentShader = "abuffer/resolve.frag",
                                                   .defines = plan.defines,
                                                   .depthFormat = Target::depthFormat,
                                                   .depthTest = false,
                                                   .ifRefused = ifRefused}));
    else
      sorts_.push_back(Pipeline::graphics(
          device,
          fullscreen("abuffer/resolve.frag", plan.defines, *stencil,
                     options.stencilCounts() ? vk::CompareOp::eLessOrEqual : vk::CompareOp::eEqual,
                     options.stencilCounts() ? vk::StencilOp::eZero : vk::StencilOp::eKeep,
                     ifRefused)));
  }
  if (!options.byInterval()) return;
  if (options.stencilCounts()) {
    findDeep_ =
        Pipeline::graphics(device, fullscreen("abuffer/find_deep.frag", options.nodes, *stencil,
                                              vk::CompareOp::eLessOrEqual, vk::StencilOp::eZero));
    return;
  }
  Defines defines = options.nodes;
  if (options.truncate) defines.emplace("TRUNCATE", "1");
  histogram_ = Pipeline::compute(device, "abuffer/histogram.comp", defines);
  arguments_ = Pipeline::compute(device, "abuffer/arguments.comp", options.nodes);
  if (options.mask == Mask::lists)
    fillLists_ = Pipeline::compute(device, "abuffer/fill_lists.comp", defines);
  else
    mask_ = Pipeline::graphics(device, fullscreen("abuffer/mask.frag", options.nodes, *stencil,
                                                  vk::CompareOp::eAlways, vk::StencilOp::eReplace));
}

void SortPasses::record(const Frame& frame, const ListMemory& memory, Push push) const {
  push.intervalCount = std::uint32_t(sorts_.size());
  push.maxFragments = options_.maxFragments;
  if (!options_.byInterval()) return runAll(frame, push);
  if (options_.stencilCounts()) return runCountingStencil(frame, push);
  frame.stage("intervals", [&] { findIntervals(frame, push); });
  if (options_.mask == Mask::lists)
    runLists(frame, memory, push);
  else
    runStencil(frame, memory, push);
}

void SortPasses::findIntervals(const Frame& frame, const Push& push) const {
  const auto run = [&](const Pipeline& pipeline, auto&& dispatch) {
    frame.bind(pipeline, push);
    dispatch();
    frame.barrier(Stage::eComputeShader,
                  Stage::eComputeShader | Stage::eFragmentShader | Stage::eDrawIndirect);
  };
  run(histogram_, [&] { frame.dispatchPixels(); });
  run(arguments_, [&] { frame.commands.dispatch(1, 1, 1); });
  if (options_.mask == Mask::lists) run(fillLists_, [&] { frame.dispatchPixels(); });
}

void SortPasses::runAll(const Frame& frame, const Push& push) const {
  frame.stage("sort", [&] {
    const Pipeline& sort = sorts_.front();
    if (options_.fragmentShader()) {
      frame.renderDepthTested({}, [&] {
        frame.bind(sort, push);
        frame.drawFullscreen();
      });
    } else {
      frame.bind(sort, push);
      frame.dispatchPixels();
    }
  });
}

void SortPasses::runLists(const Frame& frame, const ListMemory& memory, Push push) const {
  for (std::size_t i = 0; i < sorts_.size(); ++i)
    frame.stage(stageName(i), [&] {
      frame.bind(sorts_[i], forInterval(push, i));
      frame.commands.dispatchIndirect(memory.intervalArguments(),
                                      i * sizeof(Interval) + offsetof(Interval, groups));
      if (frame.instrumented) frame.barrier(Stage::eComputeShader, Stage::eComputeShader);
    });
}

void SortPasses::runStencil(const Frame& frame, const ListMemory& memory, const Push& push) const {
  using Access = vk::AccessFlagBits2;
  using Layout = vk::ImageLayout;
  stencil_->transition(frame.commands, Layout::eUndefined, Layout::eDepthStencilAttachmentOptimal,
                       Stage::eAllCommands, Access::eMemoryWrite, stencilTests,
                       Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite);
  const auto runInterval = [&](std::size_t i) {
    const Push own = forInterval(push, i);
    const auto draw = [&](const Pipeline& pipeline) {
      frame.bind(pipeline, own);
      frame.commands.setStencilReference(vk::StencilFaceFlagBits::eFrontAndBack,
                                         std::uint32_t(i) + 1);
      frame.commands.drawIndirect(memory.intervalArguments(), i * sizeof(Interval), 1, 0);
    };
    draw(mask_);
    draw(sorts_[i]);
  };
  // One pass, in which intervals may overlap; where stages are timed, a pass for each.
  if (!frame.instrumented)
    return frame.renderOnDepthStencil(*stencil_, vk::AttachmentLoadOp::eClear, [&] {
      for (std::size_t i = 0; i < sorts_.size(); ++i) runInterval(i);
    });
  for (std::size_t i = 0; i < sorts_.size(); ++i)
    frame.stage(stageName(i), [&] {
      frame.renderOnDepthStencil(
          *stencil_, i == 0 ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad,
          [&] { runInterval(i); });
      frame.barrier(Stage::eFragmentShader | stencilTests, Stage::eFragmentShader | stencilTests);
    });
}

/// The paper's second way (section 3): intervals from the deepest on, each taking the pixels of at
/// least its lower bound that are left, and zeroing their stencil. What the stencil cannot tell
/// apart, 255 fragments and more, is listed before all of them.
void SortPasses::runCountingStencil(const Frame& frame, const Push& push) const {
  if (!options_.truncate)
    frame.stage("find deep", [&] {
      frame.renderOnDepthStencil(*stencil_, vk::AttachmentLoadOp::eLoad, [&] {
        drawThroughStencil(frame, findDeep_, push, options_.intervals.back().high + 1);
      });
      frame.barrier(stencilTests, stencilTests);
    });
  const auto runInterval = [&](std::size_t i) {
    drawThroughStencil(frame, sorts_[i], forInterval(push, i), options_.intervals[i].low + 1);
  };
  if (!frame.instrumented)
    return frame.renderOnDepthStencil(*stencil_, vk::AttachmentLoadOp::eLoad, [&] {
      for (std::size_t i = sorts_.size(); i-- > 0;) runInterval(i);
    });
  for (std::size_t i = sorts_.size(); i-- > 0;)
    frame.stage(stageName(i), [&] {
      frame.renderOnDepthStencil(*stencil_, vk::AttachmentLoadOp::eLoad, [&] { runInterval(i); });
      frame.barrier(Stage::eFragmentShader | stencilTests, Stage::eFragmentShader | stencilTests);
    });
}

void SortPasses::drawThroughStencil(const Frame& frame, const Pipeline& pipeline, const Push& push,
                                    std::uint32_t reference) const {
  frame.bind(pipeline, push);
  frame.commands.setStencilReference(vk::StencilFaceFlagBits::eFrontAndBack, reference);
  frame.drawFullscreen();
}

Push SortPasses::forInterval(Push push, std::size_t interval) const {
  push.interval = std::uint32_t(interval);
  push.low = options_.intervals[interval].low;
  push.high = options_.intervals[interval].high;
  return push;
}

std::string SortPasses::stageName(std::size_t interval) const {
  return fmt::format("sort {}", options_.intervals[interval].name);
}

}  // namespace oitlab::abuffer
