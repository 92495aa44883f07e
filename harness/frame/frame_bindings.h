#pragma once

#include <span>

#include "frame/gpu_scene.h"
#include "frame/target.h"

namespace oitlab {

/// The descriptor set of shaders/common/bindings.glsl for one scene and target; both must outlive
/// it. A method that samples its own images makes a set with them: at most
/// Device::methodImageCount, and they must be in shaderReadOnlyOptimal when they are sampled. So
/// must `opaqueDepth`, which takes the place of the target's depth if it is not null.
class FrameBindings {
 public:
  FrameBindings(const Device& device, const GpuScene& scene, const Target& target,
                std::span<const GpuImage* const> methodImages = {},
                const GpuImage* opaqueDepth = nullptr);
  vk::DescriptorSet set() const { return *set_; }

 private:
  vk::raii::Sampler atlasSampler_ = nullptr, depthSampler_ = nullptr;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet set_ = nullptr;
};

}  // namespace oitlab
