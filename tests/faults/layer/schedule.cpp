#include "schedule.h"

#include <queue>

namespace oitlab::layer {
namespace {

constexpr VkPipelineStageFlags2 graphicsStages[] = {
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,          VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
    VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,   VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
};

VkPipelineStageFlags2 allGraphics() {
  VkPipelineStageFlags2 all = 0;
  for (const auto stage : graphicsStages) all |= stage;
  return all;
}

constexpr VkPipelineStageFlags2 allTransfer =
    VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT |
    VK_PIPELINE_STAGE_2_CLEAR_BIT;

}  // namespace

VkPipelineStageFlags2 expanded(VkPipelineStageFlags2 stages) {
  if (stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)
    stages |= allGraphics() | allTransfer | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  if (stages & VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT) stages |= allGraphics();
  if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) stages |= allTransfer;
  if (stages & VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT)
    stages |= VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT;
  return stages;
}

void dropGroup(std::vector<Node>& nodes, int group) {
  for (Node& node : nodes)
    if (node.barrier && node.group == group) node.from = node.to = 0;
}

std::vector<std::size_t> adversarialOrder(const std::vector<Node>& nodes) {
  std::vector<VkPipelineStageFlags2> from, to;
  for (const Node& node : nodes) {
    from.push_back(expanded(node.from));
    to.push_back(expanded(node.to));
  }
  // Two actions wait for each other only through a barrier.
  auto waits = [&](std::size_t earlier, std::size_t later) {
    if (!nodes[earlier].barrier && !nodes[later].barrier) return false;
    return (to[earlier] & from[later]) != 0;
  };
  std::vector<std::size_t> missing(nodes.size(), 0);  // earlier nodes still to come
  for (std::size_t later = 0; later < nodes.size(); ++later)
    for (std::size_t earlier = 0; earlier < later; ++earlier)
      missing[later] += waits(earlier, later);
  std::priority_queue<std::size_t> ready;  // the last recorded first
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (missing[i] == 0) ready.push(i);
  std::vector<std::size_t> order;
  while (!ready.empty()) {
    const std::size_t node = ready.top();
    ready.pop();
    order.push_back(node);
    for (std::size_t later = node + 1; later < nodes.size(); ++later)
      if (waits(node, later) && --missing[later] == 0) ready.push(later);
  }
  return order;
}

}  // namespace oitlab::layer
