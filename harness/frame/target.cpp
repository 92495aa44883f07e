#include "frame/target.h"

#include <glm/gtc/packing.hpp>

#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

struct FormatEntry {
  TargetFormat format;
  const char* name;
  vk::Format vulkan;
  std::uint32_t bytesPerPixel;
};
constexpr std::array formats = {
    FormatEntry{TargetFormat::rgba16f, "rgba16f", vk::Format::eR16G16B16A16Sfloat, 8},
    FormatEntry{TargetFormat::rgba8, "rgba8", vk::Format::eR8G8B8A8Unorm, 4},
    FormatEntry{TargetFormat::rgba32f, "rgba32f", vk::Format::eR32G32B32A32Sfloat, 16},
};
const FormatEntry& entryOf(TargetFormat format) {
  return formats[std::size_t(format)];
}

}  // namespace

std::string formatName(TargetFormat format) {
  return entryOf(format).name;
}
vk::Format vulkanFormat(TargetFormat format) {
  return entryOf(format).vulkan;
}

TargetFormat parseFormat(const std::string& name) {
  std::vector<std::string> names;
  for (const FormatEntry& entry : formats) {
    if (name == entry.name) return entry.format;
    names.push_back(entry.name);
  }
  fail<InputError>("unknown target format '{}'{}; there are: {}", name, didYouMean(name, names),
                   joinNames(names));
}

void checkTargetSize(const DeviceInfo& device, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t limit = device.maxImageSize;
  if (width == 0 || height == 0 || width > limit || height > limit)
    fail<InputError>("size {}x{}: each side must be from 1 to {} on {}", width, height, limit,
                     device.name);
}

Target::Target(const Device& device, std::uint32_t width, std::uint32_t height, TargetFormat format)
    : format_(format) {
  checkTargetSize(device.info(), width, height);
  using Usage = vk::ImageUsageFlagBits;
  color_ = GpuImage(device, memory_,
                    {"target color", vulkanFormat(format), width, height, 1,
                     Usage::eColorAttachment | Usage::eStorage | Usage::eTransferSrc |
                         Usage::eTransferDst | Usage::eSampled});
  depth_ =
      GpuImage(device, memory_,
               {"target depth", depthFormat, width, height, 1,
                Usage::eDepthStencilAttachment | Usage::eSampled, vk::ImageAspectFlagBits::eDepth});
}

std::vector<std::byte> Target::readBytes(const Device& device) const {
  MemoryLedger unlisted;
  const std::uint64_t bytes = pixels() * entryOf(format_).bytesPerPixel;
  const Buffer buffer(device, unlisted, "image readback", bytes, BufferKind::readback);
  device.runOnce([&](const Commands& commands) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    color_.transition(commands, Layout::eGeneral, Layout::eTransferSrcOptimal, Stage::eAllCommands,
                      Access::eMemoryWrite, Stage::eCopy, Access::eTransferRead);
    const vk::BufferImageCopy copy(
        0, 0, 0, vk::ImageSubresourceLayers(vk::ImageAspectFlagBits::eColor, 0, 0, 1),
        vk::Offset3D(), vk::Extent3D(width(), height(), 1));
    commands.copyImageToBuffer(color_.vk(), Layout::eTransferSrcOptimal, buffer.vk(), copy);
    color_.transition(commands, Layout::eTransferSrcOptimal, Layout::eGeneral, Stage::eCopy, {},
                      Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite);
    const vk::MemoryBarrier2 toHost(Stage::eCopy, Access::eTransferWrite, Stage::eHost,
                                    Access::eHostRead);
    vk::DependencyInfo dependency;
    dependency.setMemoryBarriers(toHost);
    commands.pipelineBarrier2(dependency);
  });
  const auto mapped = buffer.mapped<std::byte>();
  return {mapped.begin(), mapped.end()};
}

Image Target::toImage(std::span<const std::byte> bytes) const {
  Image image;
  image.width = int(width());
  image.height = int(height());
  image.rgba.resize(pixels() * 4);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    switch (format_) {
      case TargetFormat::rgba16f: {
        std::uint16_t half;
        std::memcpy(&half, bytes.data() + 2 * i, 2);
        image.rgba[i] = glm::unpackHalf1x16(half);
        break;
      }
      case TargetFormat::rgba8:
        image.rgba[i] = float(std::to_integer<int>(bytes[i])) / 255.0f;
        break;
      case TargetFormat::rgba32f:
        std::memcpy(&image.rgba[i], bytes.data() + 4 * i, 4);
        break;
    }
  }
  return image;
}

}  // namespace oitlab
