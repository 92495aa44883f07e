#pragma once

#include "frame/frame.h"
#include "frame/frame_bindings.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// The opaque pass: draws the scene's opaque triangles into the target's colour and depth.
///
/// The compute rasterizer finds other depths than the hardware for the same triangle, in the last
/// bits. So that a transparent copy of an opaque triangle is kept by both, each compares with its
/// own: the pass for the compute rasterizer also writes, for the triangle that won each pixel, what
/// that rasterizer finds (shaders/raster/opaque.frag). Which triangle wins is the hardware's
/// choice.
class OpaquePass {
 public:
  enum class DepthOf { hardware, computeRasterizer };

  /// All must outlive this. Throws DeviceError when memory is short. The hardware's depth stays
  /// where there is nothing to compare, and on devices without geometryShader (primitive ids in
  /// fragment shaders).
  OpaquePass(const Device& device, const GpuScene& scene, const Target& target, DepthOf depthOf);

  /// Records the pass. After it colour and depth are visible to all stages.
  void record(const Frame& frame) const;

  /// Set 0 of the frame's pipelines, with the opaque depth that their shaders read.
  vk::DescriptorSet bindings() const { return bindings_.set(); }

  /// The image of depths, where there is one.
  const MemoryLedger& memory() const { return memory_; }

 private:
  bool hasOwnDepth() const { return depth_.vk() != vk::Image(); }

  const GpuScene& scene_;
  const Target& target_;
  MemoryLedger memory_;
  GpuImage depth_;
  FrameBindings bindings_;
  Pipeline pipeline_;
};

/// The background behind every scene, linear: a light neutral grey, on which both dark and bright
/// layers are visible.
inline constexpr glm::vec4 backgroundColor{0.6f, 0.6f, 0.6f, 1.0f};

}  // namespace oitlab
