#include "render/opaque_pass.h"

namespace oitlab {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;

constexpr vk::Format depthFormat = vk::Format::eR32Sfloat;

/// The push constants of raster/opaque.frag; common/opaque.frag has the first.
struct OpaquePush {
  std::uint64_t frame;
  std::uint64_t indices;
};

GpuImage makeDepth(const Device& device, const GpuScene& scene, const Target& target,
                   MemoryLedger& memory, OpaquePass::DepthOf depthOf) {
  if (depthOf == OpaquePass::DepthOf::hardware || scene.opaqueCount() == 0 ||
      scene.transparentCount() == 0 || !device.info().has("geometryShader"))
    return {};
  using Usage = vk::ImageUsageFlagBits;
  return {device,
          memory,
          {"opaque depth of the compute rasterizer", depthFormat, target.width(), target.height(),
           1, Usage::eColorAttachment | Usage::eSampled}};
}

Pipeline makePipeline(const Device& device, const Target& target, bool ownDepth) {
  Pipeline::Graphics description{.fragmentShader = "common/opaque.frag",
                                 .colorFormats = {vulkanFormat(target.format())},
                                 .depthFormat = Target::depthFormat,
                                 .depthWrite = true};
  if (ownDepth) {
    description.fragmentShader = "raster/opaque.frag";
    description.colorFormats.push_back(depthFormat);
  }
  return Pipeline::graphics(device, description);
}

}  // namespace

OpaquePass::OpaquePass(const Device& device, const GpuScene& scene, const Target& target,
                       DepthOf depthOf)
    : scene_(scene),
      target_(target),
      depth_(makeDepth(device, scene, target, memory_, depthOf)),
      bindings_(device, scene, target, {}, hasOwnDepth() ? &depth_ : nullptr),
      pipeline_(makePipeline(device, target, hasOwnDepth())) {}

void OpaquePass::record(const Frame& frame) const {
  const Commands& commands = frame.commands;
  // The last frame's contents are not needed, but its accesses must have finished.
  const auto colorAccess = Access::eColorAttachmentRead | Access::eColorAttachmentWrite;
  target_.color().transition(commands, Layout::eUndefined, Layout::eGeneral, Stage::eAllCommands,
                             Access::eMemoryWrite, Stage::eColorAttachmentOutput, colorAccess);
  const auto depthStages = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
  target_.depth().transition(
      commands, Layout::eUndefined, Layout::eDepthAttachmentOptimal, Stage::eAllCommands,
      Access::eMemoryWrite, depthStages,
      Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite);

  const auto store = vk::AttachmentStoreOp::eStore;
  const auto clear = vk::AttachmentLoadOp::eClear;
  vk::RenderingAttachmentInfo color(target_.color().view(), Layout::eGeneral);
  color.loadOp = clear;
  color.storeOp = store;
  color.clearValue.color = vk::ClearColorValue(backgroundColor.r, backgroundColor.g,
                                               backgroundColor.b, backgroundColor.a);
  std::vector<vk::RenderingAttachmentInfo> colors = {color};
  if (hasOwnDepth()) {
    depth_.transition(commands, Layout::eUndefined, Layout::eColorAttachmentOptimal,
                      Stage::eAllCommands, Access::eMemoryWrite, Stage::eColorAttachmentOutput,
                      colorAccess);
    colors.push_back(clearedAttachment(depth_, {0.0f, 0.0f, 0.0f, 0.0f}));
  }
  vk::RenderingAttachmentInfo depth(target_.depth().view(), Layout::eDepthAttachmentOptimal);
  depth.loadOp = clear;
  depth.storeOp = store;
  depth.clearValue.depthStencil = vk::ClearDepthStencilValue(0.0f, 0);  // reversed: infinitely far
  vk::RenderingInfo info({}, target_.area(), 1);
  info.setColorAttachments(colors).setPDepthAttachment(&depth);
  commands.beginRendering(info);
  // A draw is recorded even without opaque triangles: lavapipe (Mesa 22.3) crashes when a pass that
  // only clears is followed by a dispatch and then by another pass.
  commands.setViewport(0,
                       vk::Viewport(0, 0, float(target_.width()), float(target_.height()), 0, 1));
  commands.setScissor(0, target_.area());
  frame.bind(pipeline_, OpaquePush{frame.constants, scene_.opaqueIndices().address()});
  commands.bindIndexBuffer(scene_.opaqueIndices().vk(), 0, vk::IndexType::eUint32);
  commands.drawIndexed(scene_.opaqueCount() * 3, 1, 0, 0, 0);
  commands.endRendering();

  target_.color().transition(commands, Layout::eGeneral, Layout::eGeneral,
                             Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite,
                             Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite);
  target_.depth().transition(
      commands, Layout::eDepthAttachmentOptimal, Layout::eDepthStencilReadOnlyOptimal, depthStages,
      Access::eDepthStencilAttachmentWrite, Stage::eAllCommands, Access::eMemoryRead);
  if (hasOwnDepth())
    depth_.transition(commands, Layout::eColorAttachmentOptimal, Layout::eShaderReadOnlyOptimal,
                      Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite,
                      Stage::eAllCommands, Access::eMemoryRead);
}

}  // namespace oitlab
