#pragma once

#include "gpu/device.h"

namespace oitlab {

/// Makes all writes of the stages `from` before it visible to the stages `to` after it.
void memoryBarrier(const Commands& commands, vk::PipelineStageFlags2 from,
                   vk::PipelineStageFlags2 to);

}  // namespace oitlab
