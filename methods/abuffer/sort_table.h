#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace oitlab::abuffer {

/// The sorts by the names of the parameter; their places are the numbers in abuffer_types.h.
inline constexpr std::array<const char*, 5> sortNames = {"insertion", "merge", "shell", "bitonic",
                                                         "register"};

/// What `sort = auto` takes: insertion sort up to so many fragments, merge sort above.
struct AutoSort {
  const char* device;              ///< part of the device's name; "" for all
  std::uint32_t insertionUpTo;     ///< in shaders for intervals
  std::uint32_t insertionUpToMax;  ///< in the shader for all pixels, which branches when it runs
};

/// The first row that fits. Section 4 of the paper found the figures of the last one on a GTX 670;
/// a row before it is for a device on which `experiments/bma.toml` (figure 9) measured better.
inline constexpr std::array autoSorts = {
    AutoSort{"", 16, 64},
};

inline const AutoSort& autoSortFor(const std::string& device) {
  for (const AutoSort& row : autoSorts)
    if (device.find(row.device) != std::string::npos) return row;
  return autoSorts.back();
}

}  // namespace oitlab::abuffer
