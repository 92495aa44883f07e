// VK_LAYER_OITLAB_reorder: runs the commands of a command buffer in another order that its barriers
// allow, and leaves out a chosen barrier. A program whose barriers suffice makes the same images in
// that order; one that lacks a barrier does not. Unlike synchronization validation it needs not
// know what a shader reads and writes through addresses.
//
//   OITLAB_REORDER=shuffle   an adversarial order; otherwise as recorded
//   OITLAB_REORDER_DROP=K    leave out the Kth group of barriers (from 1) of each command buffer: a
//                            group is barriers with no action between them
//
// Commands are kept until the command buffer ends and go to the driver then, with a whole barrier
// between each two actions, so that the order is that of the schedule on any device. An image's
// change of layout stays where its barrier is left out. Timestamps stay at their places among the
// actions; query pools are reset first, and debug labels begin and end. A render pass is one
// action. Commands that the program does not use are unknown, and end the process.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "chain.h"
#include "recording.h"

namespace oitlab::layer {
namespace {

constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 indirect = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
constexpr VkPipelineStageFlags2 drawing =
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 rendering = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                            VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT |
                                            VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

void wholeBarrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  memory.srcStageMask = memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &memory;
  OITLAB_CALL_NEXT(vkCmdPipelineBarrier2, commands, &info);
}

// Commands that are kept.

/// A command that only passes its arguments on, as a step: all of them are values.
template <Name name, typename Function>
struct Later;
template <Name name, typename... Arguments>
struct Later<name, void(VKAPI_PTR*)(VkCommandBuffer, Arguments...)> {
  using Function = void(VKAPI_PTR*)(VkCommandBuffer, Arguments...);
  static Step step(Arguments... arguments) {
    return [=](VkCommandBuffer commands) { callNext<Function>(name.text, commands, arguments...); };
  }
};
#define LATER(function, ...) Later<#function, PFN_##function>::step(__VA_ARGS__)

VKAPI_ATTR void VKAPI_CALL bindPipeline(VkCommandBuffer commands, VkPipelineBindPoint point,
                                        VkPipeline pipeline) {
  setState(commands, "pipeline " + std::to_string(point),
           LATER(vkCmdBindPipeline, point, pipeline));
}

VKAPI_ATTR void VKAPI_CALL bindDescriptorSets(VkCommandBuffer commands, VkPipelineBindPoint point,
                                              VkPipelineLayout layout, uint32_t first,
                                              uint32_t count, const VkDescriptorSet* sets,
                                              uint32_t offsetCount, const uint32_t* offsets) {
  const std::vector<VkDescriptorSet> kept(sets, sets + count);
  const std::vector<uint32_t> keptOffsets(offsets, offsets + offsetCount);
  setState(commands, "sets " + std::to_string(point), [=](VkCommandBuffer to) {
    OITLAB_CALL_NEXT(vkCmdBindDescriptorSets, to, point, layout, first, count, kept.data(),
                     offsetCount, keptOffsets.data());
  });
}

VKAPI_ATTR void VKAPI_CALL pushConstants(VkCommandBuffer commands, VkPipelineLayout layout,
                                         VkShaderStageFlags stages, uint32_t offset, uint32_t size,
                                         const void* values) {
  const auto* bytes = static_cast<const char*>(values);
  const std::vector<char> kept(bytes, bytes + size);
  setState(commands, "constants " + std::to_string(offset) + "+" + std::to_string(size),
           [=](VkCommandBuffer to) {
             OITLAB_CALL_NEXT(vkCmdPushConstants, to, layout, stages, offset, size,
                              static_cast<const void*>(kept.data()));
           });
}

VKAPI_ATTR void VKAPI_CALL bindIndexBuffer(VkCommandBuffer commands, VkBuffer buffer,
                                           VkDeviceSize offset, VkIndexType type) {
  setState(commands, "indices", LATER(vkCmdBindIndexBuffer, buffer, offset, type));
}

VKAPI_ATTR void VKAPI_CALL setViewport(VkCommandBuffer commands, uint32_t first, uint32_t count,
                                       const VkViewport* viewports) {
  const std::vector<VkViewport> kept(viewports, viewports + count);
  setState(commands, "viewport", [=](VkCommandBuffer to) {
    OITLAB_CALL_NEXT(vkCmdSetViewport, to, first, count, kept.data());
  });
}

VKAPI_ATTR void VKAPI_CALL setScissor(VkCommandBuffer commands, uint32_t first, uint32_t count,
                                      const VkRect2D* areas) {
  const std::vector<VkRect2D> kept(areas, areas + count);
  setState(commands, "scissor", [=](VkCommandBuffer to) {
    OITLAB_CALL_NEXT(vkCmdSetScissor, to, first, count, kept.data());
  });
}

VKAPI_ATTR void VKAPI_CALL setStencilReference(VkCommandBuffer commands, VkStencilFaceFlags faces,
                                               uint32_t reference) {
  setState(commands, "stencil " + std::to_string(faces),
           LATER(vkCmdSetStencilReference, faces, reference));
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
  addAction(commands, compute, LATER(vkCmdDispatch, x, y, z));
}

VKAPI_ATTR void VKAPI_CALL dispatchIndirect(VkCommandBuffer commands, VkBuffer buffer,
                                            VkDeviceSize offset) {
  addAction(commands, compute | indirect, LATER(vkCmdDispatchIndirect, buffer, offset));
}

VKAPI_ATTR void VKAPI_CALL draw(VkCommandBuffer commands, uint32_t vertices, uint32_t instances,
                                uint32_t firstVertex, uint32_t firstInstance) {
  addAction(commands, drawing, LATER(vkCmdDraw, vertices, instances, firstVertex, firstInstance));
}

VKAPI_ATTR void VKAPI_CALL drawIndexed(VkCommandBuffer commands, uint32_t indices,
                                       uint32_t instances, uint32_t firstIndex, int32_t offset,
                                       uint32_t firstInstance) {
  addAction(commands, drawing | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
            LATER(vkCmdDrawIndexed, indices, instances, firstIndex, offset, firstInstance));
}

VKAPI_ATTR void VKAPI_CALL drawIndirect(VkCommandBuffer commands, VkBuffer buffer,
                                        VkDeviceSize offset, uint32_t count, uint32_t stride) {
  addAction(commands, drawing | indirect, LATER(vkCmdDrawIndirect, buffer, offset, count, stride));
}

VKAPI_ATTR void VKAPI_CALL drawIndexedIndirect(VkCommandBuffer commands, VkBuffer buffer,
                                               VkDeviceSize offset, uint32_t count,
                                               uint32_t stride) {
  addAction(commands, drawing | indirect | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
            LATER(vkCmdDrawIndexedIndirect, buffer, offset, count, stride));
}

VKAPI_ATTR void VKAPI_CALL fillBuffer(VkCommandBuffer commands, VkBuffer buffer,
                                      VkDeviceSize offset, VkDeviceSize size, uint32_t value) {
  addAction(commands, VK_PIPELINE_STAGE_2_CLEAR_BIT,
            LATER(vkCmdFillBuffer, buffer, offset, size, value));
}

VKAPI_ATTR void VKAPI_CALL updateBuffer(VkCommandBuffer commands, VkBuffer buffer,
                                        VkDeviceSize offset, VkDeviceSize size, const void* data) {
  const auto* bytes = static_cast<const char*>(data);
  const std::vector<char> kept(bytes, bytes + size);
  addAction(commands, VK_PIPELINE_STAGE_2_CLEAR_BIT, [=](VkCommandBuffer to) {
    OITLAB_CALL_NEXT(vkCmdUpdateBuffer, to, buffer, offset, size,
                     static_cast<const void*>(kept.data()));
  });
}

VKAPI_ATTR void VKAPI_CALL copyBuffer(VkCommandBuffer commands, VkBuffer from, VkBuffer to,
                                      uint32_t count, const VkBufferCopy* regions) {
  const std::vector<VkBufferCopy> kept(regions, regions + count);
  addAction(commands, VK_PIPELINE_STAGE_2_COPY_BIT, [=](VkCommandBuffer target) {
    OITLAB_CALL_NEXT(vkCmdCopyBuffer, target, from, to, count, kept.data());
  });
}

VKAPI_ATTR void VKAPI_CALL copyBufferToImage(VkCommandBuffer commands, VkBuffer from, VkImage to,
                                             VkImageLayout layout, uint32_t count,
                                             const VkBufferImageCopy* regions) {
  const std::vector<VkBufferImageCopy> kept(regions, regions + count);
  addAction(commands, VK_PIPELINE_STAGE_2_COPY_BIT, [=](VkCommandBuffer target) {
    OITLAB_CALL_NEXT(vkCmdCopyBufferToImage, target, from, to, layout, count, kept.data());
  });
}

VKAPI_ATTR void VKAPI_CALL copyImageToBuffer(VkCommandBuffer commands, VkImage from,
                                             VkImageLayout layout, VkBuffer to, uint32_t count,
                                             const VkBufferImageCopy* regions) {
  const std::vector<VkBufferImageCopy> kept(regions, regions + count);
  addAction(commands, VK_PIPELINE_STAGE_2_COPY_BIT, [=](VkCommandBuffer target) {
    OITLAB_CALL_NEXT(vkCmdCopyImageToBuffer, target, from, layout, to, count, kept.data());
  });
}

VKAPI_ATTR void VKAPI_CALL beginRendering(VkCommandBuffer commands, const VkRenderingInfo* info) {
  const std::vector<VkRenderingAttachmentInfo> colors(
      info->pColorAttachments, info->pColorAttachments + info->colorAttachmentCount);
  using Attachments = std::vector<VkRenderingAttachmentInfo>;  // of none or one
  const auto copied = [](const VkRenderingAttachmentInfo* attachment) {
    return attachment != nullptr ? Attachments{*attachment} : Attachments{};
  };
  const Attachments depth = copied(info->pDepthAttachment);
  const Attachments stencil = copied(info->pStencilAttachment);
  addAction(commands, rendering, [=, kept = *info](VkCommandBuffer to) {
    VkRenderingInfo copy = kept;
    copy.pColorAttachments = colors.data();
    copy.pDepthAttachment = depth.empty() ? nullptr : depth.data();
    copy.pStencilAttachment = stencil.empty() ? nullptr : stencil.data();
    OITLAB_CALL_NEXT(vkCmdBeginRendering, to, &copy);
  });
  recordingOf(commands).inRendering = true;
}

VKAPI_ATTR void VKAPI_CALL endRendering(VkCommandBuffer commands) {
  addAction(commands, 0, LATER(vkCmdEndRendering));
  recordingOf(commands).inRendering = false;
}

VKAPI_ATTR void VKAPI_CALL beginQuery(VkCommandBuffer commands, VkQueryPool pool, uint32_t query,
                                      VkQueryControlFlags flags) {
  addAction(commands, 0, LATER(vkCmdBeginQuery, pool, query, flags));
}

VKAPI_ATTR void VKAPI_CALL endQuery(VkCommandBuffer commands, VkQueryPool pool, uint32_t query) {
  addAction(commands, 0, LATER(vkCmdEndQuery, pool, query));
}

VKAPI_ATTR void VKAPI_CALL writeTimestamp2(VkCommandBuffer commands, VkPipelineStageFlags2 stage,
                                           VkQueryPool pool, uint32_t query) {
  Recording& recording = recordingOf(commands);
  recording.stamps.emplace_back(recording.nodes.size(),
                                LATER(vkCmdWriteTimestamp2, stage, pool, query));
}

VKAPI_ATTR void VKAPI_CALL pipelineBarrier2(VkCommandBuffer commands,
                                            const VkDependencyInfo* info) {
  Recording& recording = recordingOf(commands);
  const std::vector<VkMemoryBarrier2> memory(info->pMemoryBarriers,
                                             info->pMemoryBarriers + info->memoryBarrierCount);
  const std::vector<VkBufferMemoryBarrier2> buffers(
      info->pBufferMemoryBarriers, info->pBufferMemoryBarriers + info->bufferMemoryBarrierCount);
  std::vector<VkImageMemoryBarrier2> images(
      info->pImageMemoryBarriers, info->pImageMemoryBarriers + info->imageMemoryBarrierCount);
  Node node{.barrier = true};
  for (const auto& b : memory) node.from |= b.srcStageMask, node.to |= b.dstStageMask;
  for (const auto& b : buffers) node.from |= b.srcStageMask, node.to |= b.dstStageMask;
  for (const auto& b : images) node.from |= b.srcStageMask, node.to |= b.dstStageMask;
  if (recording.nodes.empty() || !recording.nodes.back().barrier) ++recording.groups;
  node.group = recording.groups;
  const bool dropped = node.group == reorder().drop;
  if (dropped)
    for (auto& b : images) b.srcStageMask = b.dstStageMask = b.srcAccessMask = b.dstAccessMask = 0;
  recording.nodes.push_back(node);
  recording.steps.push_back({[=](VkCommandBuffer to) {
    VkDependencyInfo kept{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    kept.memoryBarrierCount = dropped ? 0 : uint32_t(memory.size());
    kept.pMemoryBarriers = memory.data();
    kept.bufferMemoryBarrierCount = dropped ? 0 : uint32_t(buffers.size());
    kept.pBufferMemoryBarriers = buffers.data();
    kept.imageMemoryBarrierCount = uint32_t(images.size());
    kept.pImageMemoryBarriers = images.data();
    if (dropped && images.empty()) return;
    OITLAB_CALL_NEXT(vkCmdPipelineBarrier2, to, &kept);
  }});
}

VKAPI_ATTR VkResult VKAPI_CALL beginCommandBuffer(VkCommandBuffer commands,
                                                  const VkCommandBufferBeginInfo* info) {
  recordingOf(commands) = {};
  return OITLAB_CALL_NEXT(vkBeginCommandBuffer, commands, info);
}

VKAPI_ATTR VkResult VKAPI_CALL endCommandBuffer(VkCommandBuffer commands) {
  const Recording recording = std::move(recordingOf(commands));
  reorder().nodes = recording.nodes;
  std::vector<std::size_t> order(recording.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  if (reorder().shuffle) {
    std::vector<Node> nodes = recording.nodes;
    dropGroup(nodes, reorder().drop);
    order = adversarialOrder(nodes);
  }
  auto stamp = recording.stamps.begin();
  for (std::size_t place = 0; place <= order.size(); ++place) {
    for (; stamp != recording.stamps.end() && stamp->first == place; ++stamp)
      stamp->second(commands);
    if (place == order.size()) break;
    if (reorder().shuffle) wholeBarrier(commands);
    for (const Step& step : recording.steps[order[place]]) step(commands);
  }
  if (reorder().shuffle) wholeBarrier(commands);
  return OITLAB_CALL_NEXT(vkEndCommandBuffer, commands);
}

/// In the place of every other command. Left alone it would come before all that is kept.
VKAPI_ATTR void VKAPI_CALL unknownCommand() {
  std::fprintf(stderr,
               "VK_LAYER_OITLAB_reorder: a command that it does not know; add it in "
               "tests/faults/layer/reorder.cpp\n");
  std::abort();
}

// The conversion to PFN_... checks that `own` has the function's arguments.
#define KEPT(function, own)                                                                 \
  Hook {                                                                                    \
#function, reinterpret_cast < PFN_vkVoidFunction>(static_cast <PFN_##function>(&(own))) \
  }

}  // namespace

std::span<const Hook> deviceHooks() {
  static const std::array hooks = {
      KEPT(vkBeginCommandBuffer, beginCommandBuffer),
      KEPT(vkEndCommandBuffer, endCommandBuffer),
      KEPT(vkCmdBindPipeline, bindPipeline),
      KEPT(vkCmdBindDescriptorSets, bindDescriptorSets),
      KEPT(vkCmdPushConstants, pushConstants),
      KEPT(vkCmdBindIndexBuffer, bindIndexBuffer),
      KEPT(vkCmdSetViewport, setViewport),
      KEPT(vkCmdSetScissor, setScissor),
      KEPT(vkCmdSetStencilReference, setStencilReference),
      KEPT(vkCmdDispatch, dispatch),
      KEPT(vkCmdDispatchIndirect, dispatchIndirect),
      KEPT(vkCmdDraw, draw),
      KEPT(vkCmdDrawIndexed, drawIndexed),
      KEPT(vkCmdDrawIndirect, drawIndirect),
      KEPT(vkCmdDrawIndexedIndirect, drawIndexedIndirect),
      KEPT(vkCmdFillBuffer, fillBuffer),
      KEPT(vkCmdUpdateBuffer, updateBuffer),
      KEPT(vkCmdCopyBuffer, copyBuffer),
      KEPT(vkCmdCopyBufferToImage, copyBufferToImage),
      KEPT(vkCmdCopyImageToBuffer, copyImageToBuffer),
      KEPT(vkCmdBeginRendering, beginRendering),
      KEPT(vkCmdEndRendering, endRendering),
      KEPT(vkCmdBeginQuery, beginQuery),
      KEPT(vkCmdEndQuery, endQuery),
      KEPT(vkCmdWriteTimestamp2, writeTimestamp2),
      KEPT(vkCmdPipelineBarrier2, pipelineBarrier2),
  };
  return hooks;
}

PFN_vkVoidFunction otherwise(std::string_view name) {
  // Resetting queries first is what their use asks for anyway; labels do nothing.
  if (!name.starts_with("vkCmd") || name == "vkCmdResetQueryPool" ||
      name.ends_with("DebugUtilsLabelEXT"))
    return nullptr;
  return &unknownCommand;
}

VkResult beforeCreation(const char*) {
  return VK_SUCCESS;
}

void beforeDestruction(VkDevice) {}

}  // namespace oitlab::layer

extern "C" [[gnu::visibility("default")]] oitlab::layer::Reorder* oitlabReorder() {
  return &oitlab::layer::reorder();
}
