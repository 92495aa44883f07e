#pragma once

#include <span>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// Zeroes several buffers with one dispatch. Between dispatches this is faster than one
/// vkCmdFillBuffer per buffer, which needs barriers to the transfer stage and back.
class ZeroFill {
 public:
  explicit ZeroFill(const Device& device);

  /// At most 4 buffers, each smaller than 16 GiB. The compute stage writes them; the caller records
  /// the barrier.
  void record(const Commands& commands, std::span<const Buffer* const> buffers) const;

 private:
  Pipeline pipeline_;
};

}  // namespace oitlab
