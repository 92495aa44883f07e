#pragma once

#include <cstdint>
#include <vector>

#include "render/renderer.h"

namespace oitlab {

/// How many transparent fragments each pixel has in front of the opaque depth: the work that every
/// method has.
struct DepthComplexity {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> counts;  ///< one per pixel, rows top to bottom

  std::uint64_t total = 0;    ///< fragments
  std::uint64_t covered = 0;  ///< pixels with at least one
  std::uint32_t peak = 0;     ///< most fragments of one pixel
  /// histogram[n] is the number of pixels with n fragments, for n = 0 to peak.
  std::vector<std::uint64_t> histogram;

  double meanOfAll() const;      ///< fragments per pixel; 0 without pixels
  double meanOfCovered() const;  ///< fragments per covered pixel; 0 when none is covered

  /// Computes the rest from `counts`, which must have width * height elements (checked).
  DepthComplexity(std::uint32_t width, std::uint32_t height, std::vector<std::uint32_t> counts);
};

/// Counts in one frame of the renderer's scene and target. The target's colour is then that of the
/// opaque surfaces. Throws DeviceError when the device fails or cannot count in fragment shaders.
DepthComplexity countFragments(Renderer& renderer, const Camera& camera, bool byHardware = true);

}  // namespace oitlab
