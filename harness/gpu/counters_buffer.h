#pragma once

#include <initializer_list>

#include "gpu/buffer.h"

namespace oitlab {

/// What shaders count in a frame, for the CPU to read after it. In memory of the device that the
/// CPU can map it is read where it is; where a device has none such, from a copy, which costs a
/// frame some microseconds.
class CountersBuffer {
 public:
  CountersBuffer() = default;

  /// The ledger must outlive this. `mapped`: where the CPU can map the device's memory; tests say
  /// false for the other way. Throws DeviceError when memory is short.
  CountersBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                 std::uint64_t bytes, bool mapped);
  CountersBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                 std::uint64_t bytes)
      : CountersBuffer(device, ledger, name, bytes, device.canMapItsMemory()) {}

  const Buffer& buffer() const { return counters_; }
  std::uint64_t address() const { return counters_.address(); }
  vk::Buffer vk() const { return counters_.vk(); }

  /// After the frame whose end has recordReadback(): all of it, and the first.
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

/// At the end of a frame, after shaders of the stages `from` have counted: lets the CPU read the
/// counters.
void recordReadback(const Commands& commands, std::initializer_list<const CountersBuffer*> counters,
                    vk::PipelineStageFlags2 from = vk::PipelineStageFlagBits2::eComputeShader);

}  // namespace oitlab
