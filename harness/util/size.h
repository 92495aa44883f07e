#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace oitlab {

/// "1280x720" -> {1280, 720}. Empty when the text is not two whole numbers of at most six digits
/// with an x between them. Zero is accepted here; the device says which sizes it supports.
std::optional<std::pair<std::uint32_t, std::uint32_t>> parseSize(const std::string& text);

}  // namespace oitlab
