#pragma once

#include <span>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace oitlab {

/// Zeroes several buffers by one dispatch. Between dispatches this is quicker than a
/// vkCmdFillBuffer for each, which waits for the transfer stage and back.
class ZeroFill {
 public:
  explicit ZeroFill(const Device& device);

  /// At most 4 buffers, of less than 16 GiB. Written by the compute stage; a barrier is the
  /// caller's.
  void record(const Commands& commands, std::span<const Buffer* const> buffers) const;

 private:
  Pipeline pipeline_;
};

}  // namespace oitlab
