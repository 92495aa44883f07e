#include "gpu/counters_buffer.h"

#include "gpu/barrier.h"

namespace oitlab {

CountersBuffer::CountersBuffer(const Device& device, MemoryLedger& ledger, const std::string& name,
                               std::uint64_t bytes, bool mapped)
    : counters_(device, ledger, name, bytes, mapped ? BufferKind::shared : BufferKind::device) {
  if (!mapped) readback_ = Buffer(device, ledger, name + " readback", bytes, BufferKind::readback);
}

void recordReadback(const Commands& commands,
                    std::initializer_list<const CountersBuffer*> counters) {
  using Stage = vk::PipelineStageFlagBits2;
  bool copied = false;
  for (const CountersBuffer* c : counters) {
    if (!c->readback_) continue;
    if (!copied) memoryBarrier(commands, Stage::eComputeShader, Stage::eTransfer);
    copied = true;
    commands.copyBuffer(c->vk(), c->readback_.vk(), vk::BufferCopy(0, 0, c->counters_.bytes()));
  }
  memoryBarrier(commands, copied ? Stage::eTransfer : Stage::eComputeShader, Stage::eHost);
}

}  // namespace oitlab
