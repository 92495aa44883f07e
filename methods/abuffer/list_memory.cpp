#include "abuffer/list_memory.h"

#include "util/error.h"

namespace oitlab::abuffer {

ListMemory::ListMemory(const Device& device, MemoryLedger& ledger, const Options& options,
                       std::uint64_t pixels)
    : device_(device),
      ledger_(ledger),
      pixels_(pixels),
      nodeBytes_(options.nodeBytes),
      counters_(device, ledger, "counters", sizeof(Counters)) {
  constexpr std::uint64_t word = sizeof(std::uint32_t);
  heads_ = Buffer(device, ledger, "list heads", pixels * word);
  if (options.counts()) counts_ = Buffer(device, ledger, "fragment counts", pixels * word);
  if (options.byInterval())
    intervals_ = Buffer(device, ledger, "intervals", MOST_INTERVALS * sizeof(Interval));
  if (options.byInterval() && options.mask == Mask::lists)
    lists_ = Buffer(device, ledger, "pixel lists", pixels * word);
  growNodes(std::uint64_t(double(pixels) * options.initialDepth) + 1);
  if (!options.truncate) growDeepList(256);  // few pixels are deep, if any
}

void ListMemory::growNodes(std::uint64_t fragments) {
  // Node indices and the fragment counter are 32 bits wide.
  if (fragments >= LIST_END)
    fail<DeviceError>("abuffer: {} fragments are more than the 2^32 - 1 that its lists can name",
                      fragments);
  nodes_ = Buffer();  // give the old one back first: both may not fit
  nodes_ = Buffer(device_, ledger_, "fragment nodes", fragments * nodeBytes_);
  capacity_ = std::uint32_t(fragments);
}

void ListMemory::growDeepList(std::uint64_t pixels) {
  deep_ = Buffer();
  deep_ = Buffer(device_, ledger_, "deep pixels", pixels * sizeof(DeepPixel));
  deepCapacity_ = std::uint32_t(pixels);
}

void ListMemory::clear(const Frame& frame) {
  if (frame.instrumented && !tallies_)
    tallies_ = Buffer(device_, unlisted_, "tallies", pixels_ * sizeof(Tally));
  fillBuffer(frame.commands, heads_, LIST_END);
  if (counts_) fillBuffer(frame.commands, counts_, 0);
  if (intervals_) fillBuffer(frame.commands, intervals_, 0);
  if (frame.instrumented) fillBuffer(frame.commands, tallies_, 0);
  Counters zero{};
  zero.deepGroups.z = 1;
  frame.commands.updateBuffer<Counters>(counters_.vk(), 0, zero);
}

Push ListMemory::push(const Frame& frame) const {
  Push push{};
  push.frame = frame.constants;
  push.nodes = nodes_.address();
  push.heads = heads_.address();
  push.counts = counts_.address();
  push.counters = counters_.address();
  push.intervals = intervals_.address();
  push.lists = lists_.address();
  push.deep = deep_.address();
  push.tallies = tallies_.address();
  push.capacity = capacity_;
  push.deepCapacity = deepCapacity_;
  push.counting = frame.instrumented;
  return push;
}

}  // namespace oitlab::abuffer
