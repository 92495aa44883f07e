#pragma once

#include "gpu/device.h"

namespace oitlab {

/// Whether the environment variable OITLAB_PIPELINE_STATISTICS is set. Then the statistics of the
/// driver's compiler (registers, shared memory, spills) are printed to stderr for each pipeline.
/// For tuning; see docs/performance.md.
bool wantsPipelineStatistics();

/// One line per shader stage. Prints nothing on devices without
/// VK_KHR_pipeline_executable_properties.
void printPipelineStatistics(const Device& device, vk::Pipeline pipeline, const std::string& path);

}  // namespace oitlab
