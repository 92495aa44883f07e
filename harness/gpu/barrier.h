#pragma once

#include "gpu/device.h"

namespace oitlab {

/// Makes all writes before it visible to everything after it, within `from` -> `to`.
void memoryBarrier(const Commands& commands, vk::PipelineStageFlags2 from,
                   vk::PipelineStageFlags2 to);

}  // namespace oitlab
