#pragma once

#include <nlohmann/json.hpp>

#include "gpu/shader.h"
#include "quality/compare.h"
#include "render/renderer.h"

namespace oitlab {

// The pieces of JSON that `render --json`, `info --json` and the cells share.

nlohmann::json describeDevice(const DeviceInfo& info);
nlohmann::json describeCamera(const Camera& camera);

/// {"total": N, "method": N, "buffers": {name: N}}
nlohmann::json describeMemory(const Renderer& renderer, const Method& method);

/// {"rmse", "psnr", "max_error", "pixels_off", "ssim", "flip", "flip_hdr"}: `quality` of the cells.
/// Null is what JSON has no number for, or what cannot be measured (quality/compare.h).
nlohmann::json describeComparison(const Comparison& comparison);

/// Commit, build type, validation, command line, date, and `shaders`: content hashes by label.
nlohmann::json describeProvenance(bool validation, const ShaderLibrary::Hashes& shaders);

/// The command line of this process, for provenance; set once by main().
void setCommandLine(int argc, char** argv);

/// {"name": ..., "type": ...} of every registered method's parameters.
nlohmann::json describeMethod(const MethodInfo& info);

}  // namespace oitlab
