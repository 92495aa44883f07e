#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace oitlab {

/// XXH3 128-bit hash as 32 hex digits, the same as `xxh128sum` prints. For telling whether two
/// read-backs are the same bit for bit; not for security.
std::string imageHash(std::span<const std::byte> bytes);

}  // namespace oitlab
