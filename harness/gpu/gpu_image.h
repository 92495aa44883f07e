#pragma once

#include "gpu/buffer.h"

namespace oitlab {

/// A 2D image with one view of all its mip levels. It is counted in a ledger like a Buffer.
class GpuImage {
 public:
  struct Description {
    std::string name;
    vk::Format format = vk::Format::eUndefined;
    std::uint32_t width = 0, height = 0, levels = 1;
    vk::ImageUsageFlags usage;
    vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eColor;
  };

  GpuImage() = default;

  /// Throws DeviceError with the image's name when the device has too little memory.
  GpuImage(const Device& device, MemoryLedger& ledger, const Description& description);
  ~GpuImage() { release(); }
  GpuImage(GpuImage&& other) noexcept { *this = std::move(other); }
  GpuImage& operator=(GpuImage&& other) noexcept;

  const Description& description() const { return description_; }
  vk::Image vk() const { return *image_; }
  vk::ImageView view() const { return *view_; }
  vk::Extent2D extent() const { return {description_.width, description_.height}; }

  /// Changes the layout of all levels, with an execution and memory dependency between the stages.
  void transition(const Commands& commands, vk::ImageLayout from, vk::ImageLayout to,
                  vk::PipelineStageFlags2 fromStage, vk::AccessFlags2 fromAccess,
                  vk::PipelineStageFlags2 toStage, vk::AccessFlags2 toAccess) const;

 private:
  void release();

  MemoryLedger* ledger_ = nullptr;
  std::uint64_t bytes_ = 0;
  Description description_;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Image image_ = nullptr;
  vk::raii::ImageView view_ = nullptr;
};

/// The texels or compressed blocks of one mip level.
struct LevelData {
  std::uint32_t level = 0, width = 0, height = 0;
  std::span<const std::byte> bytes;
};

/// Uploads `levels`, waits for the copy, and leaves the image in shaderReadOnlyOptimal.
void uploadImage(const Device& device, const GpuImage& image, std::span<const LevelData> levels);

}  // namespace oitlab
