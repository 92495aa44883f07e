#pragma once

#include <initializer_list>

#include "gpu/buffer.h"

namespace oitlab {

/// Counters that shaders write in a frame and the CPU reads after it. Where the CPU can map the
/// device's memory, it reads them in place. Elsewhere it reads a copy, which costs some
/// microseconds per frame.
class CountersBuffer {
 public:
  CountersBuffer() = default;

  /// The ledger must outlive this. `mapped` chooses memory that the CPU can map, and needs
  /// Device::canMapItsMemory(). Throws DeviceError when memory is short.
  CountersBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                 std::uint64_t bytes, bool mapped);
  CountersBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                 std::uint64_t bytes)
      : CountersBuffer(device, ledger, name, bytes, device.canMapItsMemory()) {}

  const Buffer& buffer() const { return counters_; }
  std::uint64_t address() const { return counters_.address(); }
  vk::Buffer vk() const { return counters_.vk(); }

  /// The counters after a frame that ended with recordReadback(): all elements, or the first.
  template <typename T>
  std::span<const T> readAll() const {
    return (readback_ ? readback_ : counters_).mapped<T>();
  }
  template <typename T>
  const T& read() const {
    return readAll<T>()[0];
  }

 private:
  friend void recordReadback(const Commands&, std::initializer_list<const CountersBuffer*>,
                             vk::PipelineStageFlags2);

  Buffer counters_, readback_;
};

/// Records, at the end of a frame, what the CPU needs to read the counters that shaders of the
/// stages `from` wrote.
void recordReadback(const Commands& commands, std::initializer_list<const CountersBuffer*> counters,
                    vk::PipelineStageFlags2 from = vk::PipelineStageFlagBits2::eComputeShader);

}  // namespace oitlab
