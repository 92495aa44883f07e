#pragma once

#include <vector>

#include <vulkan/vulkan_core.h>

namespace oitlab::layer {

/// An action of a command buffer (a dispatch, a copy, a whole render pass) or a barrier.
struct Node {
  bool barrier = false;
  VkPipelineStageFlags2 from = 0;  ///< an action: the stages it runs in; a barrier: its first scope
  VkPipelineStageFlags2 to = 0;    ///< an action: the same again; a barrier: its second scope
  int group = 0;  ///< of a barrier, from 1: barriers with no action between them are one group
};

/// `stages` with those that ALL_COMMANDS, ALL_GRAPHICS, ALL_TRANSFER and VERTEX_INPUT stand for.
VkPipelineStageFlags2 expanded(VkPipelineStageFlags2 stages);

/// Takes the scopes off all barriers of the group: they order nothing any more.
void dropGroup(std::vector<Node>& nodes, int group);

/// An order of the nodes that the barriers allow, as unlike the recorded one as can be: whatever
/// may run comes last first. A node comes after an earlier one where the earlier one's stages meet
/// a barrier's first scope and that barrier's second scope meets its own, or through a chain of
/// such barriers (Vulkan specification, "Execution dependencies"). A scope is the stages that it
/// names, without the logically earlier or later ones: memory is made visible to those alone.
/// Accesses are not looked at: a barrier with too few of them passes for a whole one. Places in
/// `nodes`, each once.
std::vector<std::size_t> adversarialOrder(const std::vector<Node>& nodes);

}  // namespace oitlab::layer
