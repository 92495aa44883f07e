#pragma once

#include <vector>

#include "schedule.h"

namespace oitlab::layer {

/// What the layer VK_LAYER_OITLAB_reorder does, for a test that has it in its own process (find the
/// function oitlabReorder in the library). It holds for command buffers that end from then on.
struct Reorder {
  bool shuffle = false;  ///< run in an adversarial order (schedule.h), else as recorded
  int drop = 0;          ///< the group of barriers to leave out of each command buffer; 0: none

  /// Actions and barriers of the last command buffer that ended, as they were recorded.
  std::vector<Node> nodes;
};

}  // namespace oitlab::layer
