#include "gpu/gpu_image.h"

#include "gpu/debug_names.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab {

GpuImage::GpuImage(const Device& device, MemoryLedger& ledger, const Description& description)
    : description_(description) {
  vk::ImageCreateInfo info;
  info.imageType = vk::ImageType::e2D;
  info.format = description.format;
  info.extent = vk::Extent3D(description.width, description.height, 1);
  info.mipLevels = description.levels;
  info.arrayLayers = 1;
  info.usage = description.usage;
  vk::DeviceSize bytes = 0;
  try {
    image_ = vk::raii::Image(device.vk(), info);
    const auto needs = image_.getMemoryRequirements();
    bytes = needs.size;
    memory_ = vk::raii::DeviceMemory(
        device.vk(), {needs.size, device.memoryType(needs.memoryTypeBits,
                                                    vk::MemoryPropertyFlagBits::eDeviceLocal)});
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("not enough device memory for image '{}' of {}x{} ({})", description.name,
                      description.width, description.height, error.what());
  }
  image_.bindMemory(*memory_, 0);
  view_ = vk::raii::ImageView(
      device.vk(), vk::ImageViewCreateInfo({}, *image_, vk::ImageViewType::e2D, description.format,
                                           {}, {description.aspect, 0, description.levels, 0, 1}));
  nameObject(device, *image_, description_.name);
  nameObject(device, *view_, description_.name);
  ledger_ = &ledger;
  bytes_ = bytes;
  ledger_->add(description_.name, bytes_);
}

GpuImage& GpuImage::operator=(GpuImage&& other) noexcept {
  if (this == &other) return *this;
  release();
  ledger_ = std::exchange(other.ledger_, nullptr);
  bytes_ = std::exchange(other.bytes_, 0);
  description_ = std::move(other.description_);
  view_ = std::move(other.view_);
  image_ = std::move(other.image_);
  memory_ = std::move(other.memory_);
  return *this;
}

void GpuImage::release() {
  if (ledger_ != nullptr) ledger_->remove(description_.name, bytes_);
  ledger_ = nullptr;
}

void GpuImage::transition(const Commands& commands, vk::ImageLayout from, vk::ImageLayout to,
                          vk::PipelineStageFlags2 fromStage, vk::AccessFlags2 fromAccess,
                          vk::PipelineStageFlags2 toStage, vk::AccessFlags2 toAccess) const {
  const vk::ImageMemoryBarrier2 barrier(fromStage, fromAccess, toStage, toAccess, from, to,
                                        VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *image_,
                                        {description_.aspect, 0, description_.levels, 0, 1});
  vk::DependencyInfo dependency;
  dependency.setImageMemoryBarriers(barrier);
  commands.pipelineBarrier2(dependency);
}

void uploadImage(const Device& device, const GpuImage& image, std::span<const LevelData> levels) {
  constexpr std::size_t alignment = 16;  // of a copy: the size of the largest block of a format
  MemoryLedger unlisted;
  std::uint64_t total = 0;
  for (const LevelData& level : levels) total += roundUp(level.bytes.size(), alignment);
  const Buffer staging(device, unlisted, "staging", total, BufferKind::upload);
  std::vector<vk::BufferImageCopy> copies;
  std::uint64_t offset = 0;
  for (const LevelData& level : levels) {
    std::memcpy(staging.mapped<std::byte>().data() + offset, level.bytes.data(),
                level.bytes.size());
    copies.emplace_back(
        offset, 0, 0,
        vk::ImageSubresourceLayers(vk::ImageAspectFlagBits::eColor, level.level, 0, 1),
        vk::Offset3D(), vk::Extent3D(level.width, level.height, 1));
    offset += roundUp(level.bytes.size(), alignment);
  }
  device.runOnce([&](const Commands& commands) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    image.transition(commands, Layout::eUndefined, Layout::eTransferDstOptimal, Stage::eNone, {},
                     Stage::eCopy, Access::eTransferWrite);
    commands.copyBufferToImage(staging.vk(), image.vk(), Layout::eTransferDstOptimal, copies);
    image.transition(commands, Layout::eTransferDstOptimal, Layout::eShaderReadOnlyOptimal,
                     Stage::eCopy, Access::eTransferWrite, Stage::eAllCommands,
                     Access::eShaderRead);
  });
}

}  // namespace oitlab
