#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace oitlab {

/// The work that one view of a scene is for a rasterizer, counted on the CPU. It compares generated
/// scenes with the figures of the papers, without a device and without memory for fragments.
struct Coverage {
  std::uint64_t samples = 0;  ///< pixel centres inside triangles, without culling and discards
  std::uint64_t coveredPixels = 0;  ///< pixels with at least one sample
  std::uint32_t peakDepth = 0;      ///< the most samples of one pixel
  std::uint64_t visible = 0;  ///< triangles in the frustum whose bounding box has a pixel centre
  std::uint64_t visibleFront = 0;  ///< those that are not back-facing
};

/// `width` and `height` in pixels, at least 1. A device's count differs a little, because the
/// device rounds vertices to its sub-pixel grid.
Coverage measureCoverage(const Scene& scene, const Camera& camera, int width, int height);

}  // namespace oitlab
