#include "gpu/buffer.h"

#include "gpu/debug_names.h"
#include "util/error.h"

namespace oitlab {
namespace {

/// Large uploads go through staging memory in pieces of this size, so that a scene of gigabytes
/// does not need the same amount of host memory again.
constexpr std::uint64_t stagingBytes = 64u << 20;

}  // namespace

std::uint64_t MemoryLedger::total() const {
  std::uint64_t sum = 0;
  for (const auto& [name, bytes] : bytes_) sum += bytes;
  return sum;
}

Buffer::Buffer(const Device& device, MemoryLedger& ledger, std::string name, std::uint64_t bytes,
               BufferKind kind)
    : name_(std::move(name)) {
  using Usage = vk::BufferUsageFlagBits;
  using Memory = vk::MemoryPropertyFlagBits;
  if (bytes > device.info().maxAllocationBytes)
    fail<DeviceError>("buffer '{}' needs {:.1f} MiB in one piece, {} allows {:.1f}", name_,
                      double(bytes) / (1 << 20), device.info().name,
                      double(device.info().maxAllocationBytes) / (1 << 20));
  const vk::BufferUsageFlags usage = Usage::eStorageBuffer | Usage::eShaderDeviceAddress |
                                     Usage::eTransferSrc | Usage::eTransferDst |
                                     Usage::eIndexBuffer | Usage::eIndirectBuffer;
  try {
    buffer_ = vk::raii::Buffer(device.vk(), vk::BufferCreateInfo({}, bytes, usage));
    const auto needs = buffer_.getMemoryRequirements();
    vk::MemoryPropertyFlags wanted = Memory::eDeviceLocal, preferred;
    if (kind == BufferKind::upload) wanted = Memory::eHostVisible | Memory::eHostCoherent;
    if (kind == BufferKind::shared)
      wanted = Memory::eDeviceLocal | Memory::eHostVisible | Memory::eHostCoherent;
    if (kind == BufferKind::readback) {
      wanted = Memory::eHostVisible | Memory::eHostCoherent;
      preferred = Memory::eHostCached;
    }
    const vk::MemoryAllocateFlagsInfo flags(vk::MemoryAllocateFlagBits::eDeviceAddress);
    memory_ = vk::raii::DeviceMemory(
        device.vk(),
        vk::MemoryAllocateInfo(needs.size,
                               device.memoryType(needs.memoryTypeBits, wanted, preferred), &flags));
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("not enough device memory for buffer '{}' of {:.1f} MiB ({})", name_,
                      double(bytes) / (1 << 20), error.what());
  }
  buffer_.bindMemory(*memory_, 0);
  nameObject(device, *buffer_, name_);
  address_ = device.vk().getBufferAddress({*buffer_});
  if (kind != BufferKind::device) mapped_ = memory_.mapMemory(0, VK_WHOLE_SIZE);
  ledger_ = &ledger;
  bytes_ = bytes;
  ledger_->add(name_, bytes_);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  release();
  ledger_ = std::exchange(other.ledger_, nullptr);
  name_ = std::move(other.name_);
  bytes_ = std::exchange(other.bytes_, 0);
  address_ = std::exchange(other.address_, 0);
  mapped_ = std::exchange(other.mapped_, nullptr);
  buffer_ = std::move(other.buffer_);
  memory_ = std::move(other.memory_);
  return *this;
}

void Buffer::release() {
  if (ledger_ != nullptr) ledger_->remove(name_, bytes_);
  ledger_ = nullptr;
  bytes_ = 0;
}

Buffer uploadBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                    std::span<const std::byte> data) {
  Buffer buffer(device, ledger, name, std::max<std::uint64_t>(data.size(), 16));
  if (data.empty()) return buffer;
  MemoryLedger unlisted;
  const Buffer staging(device, unlisted, "staging",
                       std::min<std::uint64_t>(data.size(), stagingBytes), BufferKind::upload);
  for (std::uint64_t done = 0; done < data.size(); done += stagingBytes) {
    const auto piece =
        data.subspan(done, std::min<std::uint64_t>(stagingBytes, data.size() - done));
    std::memcpy(staging.mapped<std::byte>().data(), piece.data(), piece.size());
    device.runOnce([&](const Commands& commands) {
      commands.copyBuffer(staging.vk(), buffer.vk(), vk::BufferCopy(0, done, piece.size()));
    });
  }
  return buffer;
}

void fillBuffer(const Commands& commands, const Buffer& buffer, std::uint32_t pattern) {
  commands.fillBuffer(buffer.vk(), 0, VK_WHOLE_SIZE, pattern);
}

}  // namespace oitlab
