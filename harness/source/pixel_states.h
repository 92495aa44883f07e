#pragma once

#include <optional>

#include "frame/frame.h"
#include "gpu/counters_buffer.h"

namespace oitlab {

/// The states of exclusive programs with hardware: one per pixel, in device memory. All programs of
/// a source share the memory, since they run one after the other.
class PixelStates {
 public:
  /// All must outlive this. `memory` lists the buffers.
  PixelStates(const Device& device, const Target& target, MemoryLedger& memory);

  /// Makes room for states of `bytes` each. Not between begin() and the end of the frame.
  void reserve(std::uint64_t bytes);

  /// No program has asked for room.
  bool empty() const { return !states_; }

  /// Begins a frame. Returns the address of PixelStateConstants.
  std::uint64_t begin(const Frame& frame);

  /// Records, outside a render pass, that no pixel has a state, for the fragment shaders after it.
  void open(const Frame& frame) const;

  /// Records, after the first pass of an instrumented frame, the sum of the fragments taken. Needs
  /// what fragment shaders stored to be visible to compute shaders.
  void count(const Frame& frame);

  /// The sum of the last instrumented frame, once the device has finished it; empty before that.
  std::optional<std::uint64_t> taken() const;

 private:
  const Device& device_;
  const Target& target_;
  MemoryLedger& memory_;
  Buffer constants_, taken_, states_;
  CountersBuffer sum_;
  Pipeline countTaken_;
  bool counted_ = false;
};

}  // namespace oitlab
