#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace oitlab {

/// What one view of a scene asks of a rasterizer, counted on the CPU: a check of generated scenes
/// against the papers' figures that needs no device and no memory for fragments.
struct Coverage {
  std::uint64_t samples = 0;        ///< pixel centres inside triangles; nothing culled or discarded
  std::uint64_t coveredPixels = 0;  ///< with at least one sample
  std::uint32_t peakDepth = 0;      ///< most samples in a pixel
  std::uint64_t visible = 0;        ///< triangles in the frustum whose box holds a pixel centre
  std::uint64_t visibleFront = 0;   ///< those of them that are not seen from behind
};

/// `width` and `height` in pixels, at least 1. Differs from a device's count by the rounding of
/// vertices to its sub-pixel grid.
Coverage measureCoverage(const Scene& scene, const Camera& camera, int width, int height);

}  // namespace oitlab
