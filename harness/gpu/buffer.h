#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "gpu/device.h"

namespace oitlab {

/// How much device memory each buffer and image holds, by name: the memory table of the results.
class MemoryLedger {
 public:
  void add(const std::string& name, std::uint64_t bytes) { bytes_[name] += bytes; }
  void remove(const std::string& name, std::uint64_t bytes) {
    if ((bytes_[name] -= bytes) == 0) bytes_.erase(name);
  }
  const std::map<std::string, std::uint64_t>& byName() const { return bytes_; }
  std::uint64_t total() const;

 private:
  std::map<std::string, std::uint64_t> bytes_;
};

/// In which memory a buffer is, and who reads and writes it.
enum class BufferKind {
  device,    ///< device-local; written by copies or shaders
  upload,    ///< mapped, written by the CPU in order and read by the device
  readback,  ///< mapped and cached, written by the device and read by the CPU
  shared,    ///< device-local and mapped, for small buffers; needs Device::canMapItsMemory()
};

/// A buffer with a device address. Shaders get the address through push constants and need no
/// descriptor. The buffer is counted in `ledger` under `name` while it lives; the ledger must
/// outlive it.
class Buffer {
 public:
  Buffer() = default;

  /// `bytes` > 0. Throws DeviceError with the buffer's name when the device has too little memory.
  Buffer(const Device& device, MemoryLedger& ledger, std::string name, std::uint64_t bytes,
         BufferKind kind = BufferKind::device);
  ~Buffer() { release(); }
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;

  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t address() const { return address_; }
  vk::Buffer vk() const { return *buffer_; }
  explicit operator bool() const { return bytes_ != 0; }

  /// The mapped memory as elements of type T. Not for BufferKind::device.
  template <typename T>
  std::span<T> mapped() const {
    return {static_cast<T*>(mapped_), static_cast<std::size_t>(bytes_ / sizeof(T))};
  }

 private:
  void release();

  MemoryLedger* ledger_ = nullptr;
  std::string name_;
  std::uint64_t bytes_ = 0;
  std::uint64_t address_ = 0;
  void* mapped_ = nullptr;
  vk::raii::DeviceMemory memory_ = nullptr;  // before the buffer: destroyed after it
  vk::raii::Buffer buffer_ = nullptr;
};

/// A device buffer that holds `data`. Copies it through staging memory and waits for the copy.
/// Empty data gives a small buffer, so that the address is always valid.
Buffer uploadBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                    std::span<const std::byte> data);

template <typename T>
Buffer uploadBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                    const std::vector<T>& data) {
  return uploadBuffer(device, ledger, name, std::as_bytes(std::span(data)));
}

/// Fills a whole buffer with a 32-bit pattern.
void fillBuffer(const Commands& commands, const Buffer& buffer, std::uint32_t pattern);

}  // namespace oitlab
