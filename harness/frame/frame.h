#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "frame/gpu_scene.h"
#include "frame/target.h"
#include "gpu/debug_names.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// GPU timestamps of one frame: both ends of the frame, and of each stage when they are wanted.
/// One frame is in flight at a time.
class FrameTimer {
 public:
  static constexpr std::uint32_t maxStages = 32;

  explicit FrameTimer(const Device& device);

  struct Reading {
    std::optional<double>
        frameMs;  ///< empty when the delta was zero or negative: a rejected sample
    std::vector<std::pair<std::string, double>>
        stageMs;  ///< in recording order; equal names summed
  };

  void begin(const Commands& commands, bool stages);
  void end(const Commands& commands);
  void beginStage(const Commands& commands, const std::string& name);
  void endStage(const Commands& commands);

  /// Once the device is done with the frame.
  Reading read();

  /// Ticks between two raw timestamps of which only `validBits` count, or nothing when zero, or
  /// when the difference is more than half the counter's range: then time went backwards.
  static std::optional<std::uint64_t> ticksBetween(std::uint64_t begin, std::uint64_t end,
                                                   std::uint32_t validBits);

 private:
  void stamp(const Commands& commands);

  const Device& device_;
  vk::raii::QueryPool pool_;
  std::uint32_t next_ = 0;
  bool stages_ = false;
  std::vector<std::string> names_;
};

/// What a method records into: one frame, after the opaque pass.
struct Frame {
  const Device& device;
  const Commands& commands;
  const GpuScene& scene;
  const Target& target;
  const Camera& camera;
  vk::DescriptorSet bindings;  ///< set 0 of every pipeline
  std::uint64_t constants;     ///< address of the FrameConstants
  bool instrumented;           ///< a labelled run: stages are timed, counters may cost time
  FrameTimer& timer;
  std::function<void(std::uint32_t part)> fillTarget = {};  ///< see finishTarget()

  /// For methods that say so (Method::finishesTarget), part = 0, 1, ... targetParts - 1 in turn:
  /// fills a part of the target with the background, if that is still to be done, by a compute
  /// shader, beside which short dispatches can run. Behind the last the method has a barrier
  /// between compute shaders before it touches the target.
  static constexpr std::uint32_t targetParts = 2;
  void finishTarget(std::uint32_t part) const {
    if (fillTarget) fillTarget(part);
  }

  /// Brackets a stage: a row in the results, and a label in a capture. Outside instrumented frames
  /// no timestamps are recorded, since they change what they time.
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

  /// Makes all writes before it visible to everything after it within `from` -> `to`.
  void barrier(vk::PipelineStageFlags2 from, vk::PipelineStageFlags2 to) const;

  /// A render pass on the target's colour (loaded), tested against the opaque depth (read-only).
  template <typename Draw>
  void renderOnTarget(Draw&& draw) const {
    renderDepthTested(std::array{targetAttachment()}, std::forward<Draw>(draw));
  }

  /// A render pass on attachments of the method's own, or on none (for captures), tested against
  /// the opaque depth.
  template <typename Draw>
  void renderDepthTested(std::span<const vk::RenderingAttachmentInfo> colors, Draw&& draw) const {
    beginRendering(colors);
    draw();
    commands.endRendering();
  }

  /// A render pass without colours on a depth-stencil image of the method's own, which has one or
  /// both of the aspects and is in depthStencilAttachmentOptimal. `load` eClear begins with 0 in
  /// both: infinitely far, nothing counted.
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

  /// Dispatches a compute shader with one invocation a pixel, in groups of 8x8.
  void dispatchPixels() const;

 private:
  vk::RenderingAttachmentInfo targetAttachment() const;
  void beginRendering(std::span<const vk::RenderingAttachmentInfo> colors) const;
  void beginDepthStencil(const GpuImage& image, vk::AttachmentLoadOp load) const;
  void begin(const vk::RenderingInfo& info) const;
};

/// A method's own image as an attachment that begins with `value`; in colorAttachmentOptimal.
vk::RenderingAttachmentInfo clearedAttachment(const GpuImage& image, std::array<float, 4> value);

}  // namespace oitlab
