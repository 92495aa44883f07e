#pragma once

#include <cstdint>

#include "source/fragment_program.h"

namespace oitlab {

/// The largest PixelState of an exclusive program, in bytes: 128 registers of 32 bits. Vulkan does
/// not tell how many registers a device has. NVIDIA's GPUs give an invocation 255 at most, AMD's
/// 256. The shading and rasterizing around the state need most of the other half.
inline constexpr std::uint64_t largestState = 512;

/// The bytes of the PixelState of an exclusive program, by the shader of a source that uses it.
/// Throws DeviceError when they are more than largestState, InputError when the shader does not
/// compile.
std::uint64_t stateBytes(const Device& device, const FragmentProgram& program,
                         const std::string& shader, const Defines& defines);

}  // namespace oitlab
