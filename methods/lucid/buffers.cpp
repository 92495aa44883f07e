#include "lucid/buffers.h"

#include "common/lists.h"
#include "lucid/lucid_types.h"
#include "util/error.h"

namespace oitlab::lucid {

Buffers::Buffers(const Device& device, MemoryLedger& memory) : device_(device), memory_(memory) {
  makeRoomForRepairs(1024);  // a first guess; the first frame tells
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

void Buffers::poison(const Commands& commands, std::uint32_t pattern) const {
  for (const Buffer* buffer : {&repairs, &deepPixels, &nodes})
    if (*buffer) fillBuffer(commands, *buffer, pattern);
}

}  // namespace oitlab::lucid
