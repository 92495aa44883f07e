#pragma once

#include <string>

#include "frame/gpu_scene.h"
#include "gpu/lazy_pipeline.h"
#include "method/parameters.h"

namespace oitlab::lucid {

/// The programs of shaders/lucid for one device, scene and set of parameters. They leave
/// out the code for what the scene does not have.
struct Programs {
  /// `hasUnsnapped`: frames have triangles that cannot be snapped. `device` must outlive this.
  Programs(const Device& device, const GpuScene& scene, bool hasUnsnapped,
           const std::string& targetFormat, const Parameters& parameters);

  bool unsnapped = false;

  /// Short lists are blended with a depth filter of 1 first.
  bool ordersFirst = false;

  LazyPipeline ordered, sortLow, sortHigh, lowRaster, highRaster;
  LazyPipeline repair, deepCapture, deepResolve;
};

/// Half-blocks that a workgroup works on side by side. They wait for each other, but each workgroup
/// takes 1 KB of shared memory beside what it asks for (docs/performance.md); a CPU has fewer
/// workgroups to start.
struct Teams {
  explicit Teams(const Device& device);
  std::uint32_t ordered, low;
};

}  // namespace oitlab::lucid
