#pragma once

#include "abuffer/abuffer_types.h"
#include "abuffer/options.h"
#include "frame/frame.h"
#include "gpu/counters_buffer.h"

namespace oitlab::abuffer {

/// The buffers of the method, as large as the options need and as the frames have shown.
class ListMemory {
 public:
  /// For `pixels` pixels; what is the method's own is listed in `ledger`, which must outlive this.
  ListMemory(const Device& device, MemoryLedger& ledger, const Options& options,
             std::uint64_t pixels);

  /// Makes room for `fragments`. Throws DeviceError when they are more than an index can name.
  void growNodes(std::uint64_t fragments);
  void growDeepList(std::uint64_t pixels);

  /// Empty lists and counters at 0, not yet made visible.
  void clear(const Frame& frame);

  /// Holds Counters.
  const CountersBuffer& counters() const { return counters_; }

  std::uint32_t capacity() const { return capacity_; }          ///< nodes
  std::uint32_t deepCapacity() const { return deepCapacity_; }  ///< pixels
  vk::Buffer intervalArguments() const { return intervals_.vk(); }

  /// The addresses and capacities; the rest is left at 0.
  Push push(const Frame& frame) const;

 private:
  const Device& device_;
  MemoryLedger& ledger_;
  /// The tallies prove in instrumented frames that nothing was lost: they are no part of the
  /// method.
  MemoryLedger unlisted_;
  std::uint64_t pixels_;
  std::uint32_t nodeBytes_, capacity_ = 0, deepCapacity_ = 0;
  Buffer nodes_, heads_, counts_, intervals_, lists_, deep_, tallies_;
  CountersBuffer counters_;
};

}  // namespace oitlab::abuffer
