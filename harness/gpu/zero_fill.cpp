#include "gpu/zero_fill.h"

#include <algorithm>

#include "common/zero_fill.h"
#include "util/check.h"

namespace oitlab {

ZeroFill::ZeroFill(const Device& device)
    : pipeline_(Pipeline::compute(device, "common/zero_fill.comp")) {}

void ZeroFill::record(const Commands& commands, std::span<const Buffer* const> buffers) const {
  OITLAB_CHECK_OP(buffers.size(), <=, std::size_t(ZERO_FILL_BUFFERS));
  ZeroFillPush push{};
  std::uint32_t most = 1;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    push.buffers[i] = buffers[i]->address();
    push.words[i] = std::uint32_t(buffers[i]->bytes() / 4);
    most = std::max(most, push.words[i]);
  }
  // A few words per invocation: few invocations start quickly, and there are enough for a GPU.
  constexpr std::uint32_t wordsEach = 8;
  const std::uint32_t groups = std::clamp(most / (wordsEach * ZERO_FILL_GROUP), 1u, 65535u);
  push.invocations = groups * ZERO_FILL_GROUP;
  pipeline_.bind(commands, nullptr, push);
  commands.dispatch(groups, 1, 1);
}

}  // namespace oitlab
