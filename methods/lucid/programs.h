#pragma once

#include <array>
#include <string>

#include "gpu/pipeline.h"
#include "method/parameters.h"
#include "scene/scene.h"

namespace oitlab::lucid {

/// llvmpipe ends long loops early and in silence: there the turns are counted.
bool verifiesLoops(const Device& device);

/// The programs of shaders/lucid for one device, scene and set of parameters. What the scene has
/// not is not in them.
struct Programs {
  Programs() = default;

  /// `hasOpaque`: the scene has opaque triangles. `hasIrregular`: frames have triangles that cannot
  /// be snapped. Throws DeviceError when the driver refuses one.
  Programs(const Device& device, const Scene& scene, bool hasOpaque, bool hasIrregular,
           const std::string& targetFormat, const Parameters& parameters);

  bool irregular = false;

  /// Short lists are blended with a depth filter of 1 first.
  bool ordersFirst = false;

  std::array<Pipeline, 3> blocks;  ///< by PASS of blocks.comp
  Pipeline ordered, sortLow, sortHigh, lowRaster, highRaster;
  Pipeline repair, deepCapture, deepResolve;
};

}  // namespace oitlab::lucid
