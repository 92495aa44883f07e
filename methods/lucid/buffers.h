#pragma once

#include "gpu/buffer.h"
#include "gpu/counters_buffer.h"

namespace oitlab::lucid {

/// What LucidRaster keeps between its steps, beside the front end's. Buffers grow by what a frame
/// counted: each makeRoom...() gives the old contents up. Throws DeviceError when memory is short,
/// or when 32 bits cannot name as many.
struct Buffers {
  /// `memory` must outlive this and lists the buffers. `halfBlocks`: of the frame.
  Buffers(const Device& device, MemoryLedger& memory, std::uint64_t halfBlocks);

  void makeRoomForSegments(std::uint64_t segments);
  /// `cached`: those of high bins.
  void makeRoomForLists(std::uint64_t triHalfBlocks, std::uint64_t cached);
  void makeRoomForRepairs(std::uint64_t jobs);
  void makeRoomForDeep(std::uint64_t pixels, std::uint64_t fragments);

  /// Of the lists and what is made on the way to them.
  std::uint64_t scratchBytes() const;

  /// Fills everything that a frame must write before it reads, for a test that it does.
  void poison(const Commands& commands, std::uint32_t pattern) const;

  Buffer list, keys, blocks, filterJobs, binBlocks, segmentLists, repairs;
  Buffer deepPixels, nodes;
  CountersBuffer counters;
  std::uint32_t listCapacity = 0, cachedCapacity = 0, repairCapacity = 0, deepCapacity = 0,
                nodeCapacity = 0;

 private:
  const Device& device_;
  MemoryLedger& memory_;
};

}  // namespace oitlab::lucid
