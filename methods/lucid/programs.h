#pragma once

#include <functional>
#include <optional>
#include <string>

#include "gpu/pipeline.h"
#include "method/parameters.h"
#include "scene/scene.h"

namespace oitlab::lucid {

/// llvmpipe ends long loops early without an error. On it, shaders count their iterations.
bool verifiesLoops(const Device& device);

/// The macros that lucid/team.glsl needs, for this device.
Defines teamDefines(const Device& device);

/// A program that is made when it is first asked for: many frames need few of them, and drivers
/// take their time (llvmpipe seconds).
class Program {
 public:
  Program() = default;
  explicit Program(std::function<Pipeline()> make) : make_(std::move(make)) {}

  /// Throws DeviceError when the driver refuses it.
  const Pipeline& operator*() const {
    if (!pipeline_) pipeline_ = make_();
    return *pipeline_;
  }

 private:
  std::function<Pipeline()> make_;
  mutable std::optional<Pipeline> pipeline_;
};

/// The programs of shaders/lucid for one device, scene and set of parameters. They leave
/// out the code for what the scene does not have.
struct Programs {
  /// `hasOpaque`: the scene has opaque triangles. `hasUnsnapped`: frames have triangles that cannot
  /// be snapped. `device` must outlive this.
  Programs(const Device& device, const Scene& scene, bool hasOpaque, bool hasUnsnapped,
           const std::string& targetFormat, const Parameters& parameters);

  bool unsnapped = false;

  /// Short lists are blended with a depth filter of 1 first.
  bool ordersFirst = false;

  Program countHigh, countAndWriteLow, writeHigh;  ///< the passes of blocks.comp
  Program ordered, sortLow, sortHigh, lowRaster, highRaster;
  Program repair, deepCapture, deepResolve;
};

}  // namespace oitlab::lucid
