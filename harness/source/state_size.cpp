#include "source/state_size.h"

#include "gpu/struct_size.h"
#include "source/program_contract.h"
#include "util/error.h"

namespace oitlab {

std::uint64_t stateBytes(const Device& device, const FragmentProgram& program,
                         const std::string& shader, const Defines& defines) {
  const auto words =
      makeProgram(program, [&] { return device.shaders().compile(shader, defines); });
  const std::uint64_t bytes = structBytes(words, "PixelState");
  if (bytes > largestState)
    fail<DeviceError>(
        "shaders/{}: PixelState has {} bytes, {} registers of 32 bits; at most {} fit beside the "
        "source's own (NVIDIA's GPUs give an invocation 255, AMD's 256; Vulkan does not tell). "
        "Keep less per pixel, or access=none with buffers of your own",
        program.file, bytes, (bytes + 3) / 4, largestState / 4);
  return bytes;
}

}  // namespace oitlab
