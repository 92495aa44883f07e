#pragma once

#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// Sorts 32-bit keys, each with a 32-bit value, on the device: ascending and stable, eight passes
/// of four bits, least significant first, each of count, scan and scatter (Satish, Harris and
/// Garland 2009, Designing Efficient Sorting Algorithms for Manycore GPUs, section 4). Barriers
/// alone order its work: any subgroup size, and no workgroup waits for another.
class RadixSort {
 public:
  /// For `count` elements, at least one. Its buffers (16 bytes an element, and counters) are made
  /// with `memory`. Throws DeviceError where there are more elements than one dispatch can sort
  /// (134 million).
  RadixSort(const Device& device, MemoryLedger& memory, std::uint32_t count);

  /// `count` of each: filled before, sorted after.
  const Buffer& keys() const { return keys_[0]; }
  const Buffer& values() const { return values_[0]; }

  /// Records the sort. The elements are to be visible to compute shaders before, and are so after.
  void record(const Commands& commands) const;

 private:
  std::uint32_t count_, blocks_;
  Pipeline countDigits_, scan_, scatter_;
  std::array<Buffer, 2> keys_, values_;
  Buffer counts_, totals_;
};

}  // namespace oitlab
