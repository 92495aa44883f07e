#include "frame/frame_bindings.h"

#include <array>

#include "util/check.h"

namespace oitlab {

FrameBindings::FrameBindings(const Device& device, const GpuScene& scene, const Target& target,
                             std::span<const GpuImage* const> methodImages,
                             const GpuImage* opaqueDepth) {
  OITLAB_CHECK_OP(methodImages.size(), <=, std::size_t(Device::methodImageCount));
  vk::SamplerCreateInfo sampler;
  sampler.magFilter = sampler.minFilter = vk::Filter::eLinear;
  sampler.mipmapMode = vk::SamplerMipmapMode::eLinear;
  sampler.addressModeU = sampler.addressModeV = vk::SamplerAddressMode::eClampToEdge;
  sampler.maxLod = VK_LOD_CLAMP_NONE;
  atlasSampler_ = vk::raii::Sampler(device.vk(), sampler);
  sampler.magFilter = sampler.minFilter = vk::Filter::eNearest;
  sampler.mipmapMode = vk::SamplerMipmapMode::eNearest;
  depthSampler_ = vk::raii::Sampler(device.vk(), sampler);

  const std::array sizes = {vk::DescriptorPoolSize(vk::DescriptorType::eCombinedImageSampler,
                                                   3 + Device::methodImageCount),
                            vk::DescriptorPoolSize(vk::DescriptorType::eStorageImage, 1)};
  pool_ = vk::raii::DescriptorPool(
      device.vk(), {vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes});
  const vk::DescriptorSetLayout layout = device.setLayout();
  set_ = std::move(vk::raii::DescriptorSets(device.vk(), {*pool_, layout}).front());

  const auto readOnly = vk::ImageLayout::eShaderReadOnlyOptimal;
  const std::array infos = {
      vk::DescriptorImageInfo(*atlasSampler_, scene.opaqueAtlas().view(), readOnly),
      vk::DescriptorImageInfo(*atlasSampler_, scene.transparentAtlas().view(), readOnly),
      vk::DescriptorImageInfo({}, target.color().view(), vk::ImageLayout::eGeneral),
      opaqueDepth != nullptr
          ? vk::DescriptorImageInfo(*depthSampler_, opaqueDepth->view(), readOnly)
          : vk::DescriptorImageInfo(*depthSampler_, target.depth().view(),
                                    vk::ImageLayout::eDepthStencilReadOnlyOptimal),
  };
  // Every element must be valid, so elements that the method does not use refer to an atlas.
  std::array<vk::DescriptorImageInfo, Device::methodImageCount> own;
  for (std::size_t i = 0; i < own.size(); ++i)
    own[i] = vk::DescriptorImageInfo(
        *depthSampler_,
        i < methodImages.size() ? methodImages[i]->view() : scene.opaqueAtlas().view(), readOnly);
  std::array<vk::WriteDescriptorSet, 5> writes;
  for (std::uint32_t i = 0; i < infos.size(); ++i)
    writes[i] = vk::WriteDescriptorSet(
        *set_, i, 0, 1,
        i == 2 ? vk::DescriptorType::eStorageImage : vk::DescriptorType::eCombinedImageSampler,
        &infos[i]);
  writes[4] = vk::WriteDescriptorSet(*set_, 4, 0, vk::DescriptorType::eCombinedImageSampler, own);
  device.vk().updateDescriptorSets(writes, nullptr);
}

}  // namespace oitlab
