#pragma once

#include <cstdint>
#include <vector>

#include "render/renderer.h"

namespace oitlab {

/// How many transparent fragments in front of the opaque depth each pixel has: what every method
/// has to sort, whatever the method.
struct DepthComplexity {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> counts;  ///< one a pixel, rows top to bottom

  std::uint64_t total = 0;    ///< fragments
  std::uint64_t covered = 0;  ///< pixels with at least one
  std::uint32_t peak = 0;     ///< most fragments of one pixel
  /// [n]: pixels of n fragments, n = 0 to peak.
  std::vector<std::uint64_t> histogram;

  double meanOfAll() const;      ///< fragments a pixel; 0 without pixels
  double meanOfCovered() const;  ///< fragments a covered pixel; 0 when none is

  /// Works the rest out from the counts; width * height of them (checked).
  DepthComplexity(std::uint32_t width, std::uint32_t height, std::vector<std::uint32_t> counts);
};

/// Counts in one frame of the renderer's scene and target (whose colour is left without the
/// transparent part). Throws DeviceError when the device fails or cannot count in fragment shaders.
DepthComplexity countFragments(Renderer& renderer, const Camera& camera);

}  // namespace oitlab
