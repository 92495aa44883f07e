#pragma once

#include "gpu/device.h"

namespace oitlab {

/// Whether OITLAB_PIPELINE_STATISTICS is set: what the driver's compiler says of each pipeline
/// (registers, shared memory, spills) is then printed to stderr. For tuning; see
/// docs/performance.md.
bool wantsPipelineStatistics();

/// One line per shader stage. Prints nothing on devices without
/// VK_KHR_pipeline_executable_properties.
void printPipelineStatistics(const Device& device, vk::Pipeline pipeline, const std::string& path);

}  // namespace oitlab
