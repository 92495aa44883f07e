#include "gpu/barrier.h"

namespace oitlab {

void memoryBarrier(const Commands& commands, vk::PipelineStageFlags2 from,
                   vk::PipelineStageFlags2 to) {
  using Access = vk::AccessFlagBits2;
  const vk::MemoryBarrier2 memory(from, Access::eMemoryWrite, to,
                                  Access::eMemoryRead | Access::eMemoryWrite);
  vk::DependencyInfo dependency;
  dependency.setMemoryBarriers(memory);
  commands.pipelineBarrier2(dependency);
}

}  // namespace oitlab
