#pragma once

#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// Sorts 32-bit keys, each with a 32-bit value, on the device. The sort is ascending and stable. It
/// has eight passes of four bits, least significant first, each with the steps count, scan and
/// scatter (Satish, Harris and Garland 2009, Designing Efficient Sorting Algorithms for Manycore
/// GPUs, section 4). It works with any subgroup size, and no workgroup waits for another: barriers
/// between dispatches order the steps.
class RadixSort {
 public:
  /// For `count` elements, at least one. Its buffers are listed in `memory`: 16 bytes per element,
  /// and counters. Throws DeviceError when there are more elements than one dispatch can sort
  /// (134 million).
  RadixSort(const Device& device, MemoryLedger& memory, std::uint32_t count);

  /// `count` elements each: the input before the sort, the result after it.
  const Buffer& keys() const { return keys_[0]; }
  const Buffer& values() const { return values_[0]; }

  /// Records the sort. The elements must be visible to compute shaders before it, and are visible
  /// to them after it.
  void record(const Commands& commands) const;

 private:
  std::uint32_t count_, blocks_;
  Pipeline countDigits_, scan_, scatter_;
  std::array<Buffer, 2> keys_, values_;
  Buffer counts_, totals_;
};

}  // namespace oitlab
