#pragma once

#include "gpu/buffer.h"

namespace oitlab::lucid {

/// What LucidRaster keeps between its steps, beside the lists of half-blocks. Buffers grow by what
/// a frame counted: each makeRoom...() gives the old contents up. Throws DeviceError when memory is
/// short, or when 32 bits cannot name as many.
struct Buffers {
  /// `memory` must outlive this and lists the buffers.
  Buffers(const Device& device, MemoryLedger& memory);

  void makeRoomForRepairs(std::uint64_t jobs);
  void makeRoomForDeep(std::uint64_t pixels, std::uint64_t fragments);

  /// Fills everything that a frame must write before it reads, for a test that it does.
  void poison(const Commands& commands, std::uint32_t pattern) const;

  Buffer repairs, deepPixels, nodes;
  std::uint32_t repairCapacity = 0, deepCapacity = 0, nodeCapacity = 0;

 private:
  const Device& device_;
  MemoryLedger& memory_;
};

}  // namespace oitlab::lucid
