#include "lucid/buffers.h"

#include "common/lists.h"
#include "lucid/lucid_types.h"
#include "util/error.h"

namespace oitlab::lucid {

Buffers::Buffers(const Device& device, MemoryLedger& memory, std::uint64_t halfBlocks)
    : blocks(device, memory, "half-blocks", halfBlocks * sizeof(HalfBlock)),
      filterJobs(device, memory, "depth filter jobs", halfBlocks * sizeof(PixelJob)),
      binBlocks(device, memory, "half-blocks of high bins", halfBlocks * sizeof(BinBlock)),
      counters(device, memory, "lucid counters", sizeof(LucidCounters)),
      device_(device),
      memory_(memory) {
  // First guesses; the first frame tells.
  makeRoomForLists(halfBlocks, 1024);
  makeRoomForRepairs(1024);
}

void Buffers::makeRoomForSegments(std::uint64_t segments) {
  segmentLists = Buffer();
  segmentLists = Buffer(device_, memory_, "lists of segments", segments * sizeof(SegmentLists));
}

void Buffers::makeRoomForLists(std::uint64_t triHalfBlocks, std::uint64_t cached) {
  if (triHalfBlocks >= ~0u)
    fail<DeviceError>("lucid: {} tri-half-blocks are more than 32 bits can name", triHalfBlocks);
  triHalfBlocks += triHalfBlocks % 2;
  list = Buffer();  // give the old ones back first: both may not fit
  keys = Buffer();
  list = Buffer(device_, memory_, "tri-half-blocks",
                triHalfBlocks * sizeof(TriHalfBlock) + cached * sizeof(glm::uvec4));
  keys = Buffer(device_, memory_, "depth keys", triHalfBlocks * sizeof(std::uint32_t));
  listCapacity = std::uint32_t(triHalfBlocks);
  cachedCapacity = std::uint32_t(cached);
}

void Buffers::makeRoomForRepairs(std::uint64_t jobs) {
  repairs = Buffer();
  repairs = Buffer(device_, memory_, "repair jobs", jobs * sizeof(PixelJob));
  repairCapacity = std::uint32_t(jobs);
}

void Buffers::makeRoomForDeep(std::uint64_t pixels, std::uint64_t fragments) {
  if (fragments >= LIST_END)
    fail<DeviceError>("lucid: {} fragments in deep pixels are more than 32 bits can name",
                      fragments);
  deepPixels = Buffer();
  nodes = Buffer();
  deepPixels = Buffer(device_, memory_, "deep pixels", pixels * sizeof(DeepPixel));
  nodes = Buffer(device_, memory_, "deep fragments", fragments * sizeof(Node));
  deepCapacity = std::uint32_t(pixels);
  nodeCapacity = std::uint32_t(fragments);
}

std::uint64_t Buffers::scratchBytes() const {
  std::uint64_t bytes = 0;
  for (const Buffer* buffer : {&list, &keys, &blocks, &filterJobs, &binBlocks, &segmentLists})
    bytes += buffer->bytes();
  return bytes;
}

void Buffers::poison(const Commands& commands, std::uint32_t pattern) const {
  for (const Buffer* buffer : {&list, &keys, &blocks, &filterJobs, &binBlocks, &segmentLists,
                               &repairs, &counters.buffer(), &deepPixels, &nodes})
    if (*buffer) fillBuffer(commands, *buffer, pattern);
}

}  // namespace oitlab::lucid
