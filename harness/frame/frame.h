#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/frame_types.h"
#include "frame/frame_timer.h"
#include "frame/gpu_scene.h"
#include "frame/target.h"
#include "gpu/debug_names.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// One frame after the opaque pass: what a method records its commands into.
struct Frame {
  const Device& device;
  const Commands& commands;
  const GpuScene& scene;
  const Target& target;
  const Camera& camera;
  vk::DescriptorSet bindings;  ///< set 0 of every pipeline
  std::uint64_t constants;     ///< address of `values`
  const FrameConstants& values;
  bool instrumented;  ///< stages are timed, and counters may cost time
  FrameTimer& timer;
  std::function<void(std::uint32_t part)> fillTarget = {};  ///< see finishTarget()
  bool computeRasterizer = false;  ///< Method::usesComputeRasterizer() of the method

  /// Only for methods whose usesComputeRasterizer() is true. They call it for part = 0, 1, ...
  /// targetParts - 1 in turn. It fills one part of the target with the background, if the opaque
  /// pass has not done so. It is a compute shader, and short dispatches can run beside it. After
  /// the last part the method needs a barrier between compute shaders before it touches the target.
  static constexpr std::uint32_t targetParts = 2;
  void finishTarget(std::uint32_t part) const {
    if (fillTarget) fillTarget(part);
  }

  /// Records a stage: a row in the results, and a label in a capture of the frame. Timestamps are
  /// only written in instrumented frames, because they change the time that they measure.
  template <typename Record>
  void stage(const std::string& name, Record&& record) const {
    const DebugLabel label(device, commands, name);
    if (instrumented) timer.beginStage(commands, name);
    record();
    if (instrumented) timer.endStage(commands);
  }

  /// Binds a pipeline with the images of the frame, and with push constants where it has them.
  void bind(const Pipeline& pipeline) const { pipeline.bind(commands, bindings); }
  template <typename Push>
  void bind(const Pipeline& pipeline, const Push& push) const {
    pipeline.bind(commands, bindings, push);
  }

  /// Makes all writes of the stages `from` before it visible to the stages `to` after it.
  void barrier(vk::PipelineStageFlags2 from, vk::PipelineStageFlags2 to) const;

  /// A render pass on the target's colour, which is loaded, tested against the opaque depth, which
  /// is read-only.
  template <typename Draw>
  void renderOnTarget(Draw&& draw) const {
    renderDepthTested(std::array{targetAttachment()}, std::forward<Draw>(draw));
  }

  /// A render pass on the method's own attachments, or on none (for shaders that only store to
  /// buffers), tested against the opaque depth.
  template <typename Draw>
  void renderDepthTested(std::span<const vk::RenderingAttachmentInfo> colors, Draw&& draw) const {
    beginRendering(colors);
    draw();
    commands.endRendering();
  }

  /// A render pass without colour on the method's own depth-stencil image. The image has one or
  /// both of the aspects and is in depthStencilAttachmentOptimal. With `load` eClear both start at
  /// 0: a depth that is infinitely far, and a count of zero.
  template <typename Draw>
  void renderOnDepthStencil(const GpuImage& image, vk::AttachmentLoadOp load, Draw&& draw) const {
    beginDepthStencil(image, load);
    draw();
    commands.endRendering();
  }

  /// One triangle over the whole target, for pipelines with common/fullscreen.vert.
  void drawFullscreen() const { commands.draw(3, 1, 0, 0); }

  /// Draws all transparent triangles in submission order with the bound pipeline.
  void drawTransparent() const;

  /// Dispatches a compute shader with one invocation per pixel, in workgroups of 8x8.
  void dispatchPixels() const;

 private:
  vk::RenderingAttachmentInfo targetAttachment() const;
  void beginRendering(std::span<const vk::RenderingAttachmentInfo> colors) const;
  void beginDepthStencil(const GpuImage& image, vk::AttachmentLoadOp load) const;
  void begin(const vk::RenderingInfo& info) const;
};

/// A method's own image, in colorAttachmentOptimal, as an attachment that is cleared to `value`.
vk::RenderingAttachmentInfo clearedAttachment(const GpuImage& image, std::array<float, 4> value);

}  // namespace oitlab
