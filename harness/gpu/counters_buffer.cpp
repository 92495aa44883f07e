#include "gpu/counters_buffer.h"

#include "gpu/barrier.h"

namespace oitlab {

CountersBuffer::CountersBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                               std::uint64_t bytes, bool mapped)
    : counters_(device, ledger, name, bytes, mapped ? BufferKind::shared : BufferKind::device) {
  if (!mapped) readback_ = Buffer(device, ledger, name + " readback", bytes, BufferKind::readback);
}

void recordReadback(const Commands& commands, std::initializer_list<const CountersBuffer*> counters,
                    vk::PipelineStageFlags2 from) {
  using Stage = vk::PipelineStageFlagBits2;
  bool copied = false;
  for (const CountersBuffer* c : counters) {
    if (!c->readback_) continue;
    if (!copied) memoryBarrier(commands, from, Stage::eTransfer);
    copied = true;
    commands.copyBuffer(c->vk(), c->readback_.vk(), vk::BufferCopy(0, 0, c->counters_.bytes()));
  }
  memoryBarrier(commands, copied ? vk::PipelineStageFlags2(Stage::eTransfer) : from, Stage::eHost);
}

}  // namespace oitlab
