#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "reorder.h"
#include "schedule.h"

namespace oitlab::layer {

using Step = std::function<void(VkCommandBuffer)>;

/// A command buffer while it is recorded.
struct Recording {
  std::vector<Node> nodes;
  std::vector<std::vector<Step>> steps;              ///< of each node: state, then commands
  std::vector<std::pair<std::string, Step>> state;   ///< in force: by what it sets
  std::vector<std::pair<std::size_t, Step>> stamps;  ///< how many nodes were before each
  int groups = 0;                                    ///< of barriers
  bool inRendering = false;
};

Recording& recordingOf(VkCommandBuffer commands);

/// State holds until it is set again; every action begins with all that is in force.
void setState(VkCommandBuffer commands, const std::string& what, Step step);

/// An action of the given stages: a node of its own, or a part of the render pass that is recorded.
void addAction(VkCommandBuffer commands, VkPipelineStageFlags2 stages, Step step);

/// What the environment asks for, and a test may change (reorder.h).
Reorder& reorder();

}  // namespace oitlab::layer
