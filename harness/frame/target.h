#pragma once

#include <string>
#include <vector>

#include "gpu/gpu_image.h"
#include "image/image.h"

namespace oitlab {

/// Pixel formats of the colour target. All of them hold linear values.
enum class TargetFormat { rgba16f, rgba8, rgba32f };

/// The name of a format, such as "rgba16f", and back. parseFormat() throws InputError with the list
/// of names.
std::string formatName(TargetFormat format);
TargetFormat parseFormat(const std::string& name);
vk::Format vulkanFormat(TargetFormat format);

/// Throws InputError when a side is 0 or larger than `device` allows.
void checkTargetSize(const DeviceInfo& device, std::uint32_t width, std::uint32_t height);

/// The images that a frame is rendered to. The colour is always in layout GENERAL and is used both
/// as an attachment and as a storage image. The depth is that of the opaque surfaces: reversed,
/// D32.
class Target {
 public:
  /// Throws what checkTargetSize() throws, and DeviceError when memory is short.
  Target(const Device& device, std::uint32_t width, std::uint32_t height, TargetFormat format);

  std::uint32_t width() const { return color_.description().width; }
  std::uint32_t height() const { return color_.description().height; }
  std::uint64_t pixels() const { return std::uint64_t(width()) * height(); }
  vk::Rect2D area() const { return {{0, 0}, color_.extent()}; }
  TargetFormat format() const { return format_; }
  const GpuImage& color() const { return color_; }
  const GpuImage& depth() const { return depth_; }
  const MemoryLedger& memory() const { return memory_; }
  static constexpr vk::Format depthFormat = vk::Format::eD32Sfloat;

  /// Reads the colour back as the bytes that are stored. Not during a measurement.
  std::vector<std::byte> readBytes(const Device& device) const;
  /// Those bytes as floats.
  Image toImage(std::span<const std::byte> bytes) const;

 private:
  TargetFormat format_;
  MemoryLedger memory_;
  GpuImage color_, depth_;
};

}  // namespace oitlab
