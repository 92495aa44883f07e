#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace oitlab {

/// The 128-bit XXH3 hash as 32 hex digits, the same as `xxh128sum` prints. It tells whether two
/// images are equal bit for bit. It is not for security.
std::string imageHash(std::span<const std::byte> bytes);

}  // namespace oitlab
