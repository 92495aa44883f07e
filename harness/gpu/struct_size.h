#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace oitlab {

/// The bytes of the structure `name` of a shader in scalar block layout, where a bool is a uint.
/// `words` is the SPIR-V, with names, as ShaderLibrary::compile() returns it. Throws InputError
/// when the shader does not use such a structure.
std::uint64_t structBytes(std::span<const std::uint32_t> words, std::string_view name);

}  // namespace oitlab
