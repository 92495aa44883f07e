#include "frame/frame.h"

#include "gpu/barrier.h"
#include "util/rounding.h"

namespace oitlab {

void Frame::barrier(vk::PipelineStageFlags2 from, vk::PipelineStageFlags2 to) const {
  memoryBarrier(commands, from, to);
}

vk::RenderingAttachmentInfo Frame::targetAttachment() const {
  vk::RenderingAttachmentInfo info(target.color().view(), vk::ImageLayout::eGeneral);
  info.loadOp = vk::AttachmentLoadOp::eLoad;
  info.storeOp = vk::AttachmentStoreOp::eStore;
  return info;
}

vk::RenderingAttachmentInfo clearedAttachment(const GpuImage& image, std::array<float, 4> value) {
  vk::RenderingAttachmentInfo info(image.view(), vk::ImageLayout::eColorAttachmentOptimal);
  info.loadOp = vk::AttachmentLoadOp::eClear;
  info.storeOp = vk::AttachmentStoreOp::eStore;
  info.clearValue.color = vk::ClearColorValue(value);
  return info;
}

void Frame::beginRendering(std::span<const vk::RenderingAttachmentInfo> colors) const {
  vk::RenderingAttachmentInfo depth(target.depth().view(),
                                    vk::ImageLayout::eDepthStencilReadOnlyOptimal);
  depth.loadOp = vk::AttachmentLoadOp::eLoad;
  depth.storeOp = vk::AttachmentStoreOp::eNone;
  vk::RenderingInfo info({}, target.area(), 1);
  info.colorAttachmentCount = std::uint32_t(colors.size());
  info.pColorAttachments = colors.data();
  info.setPDepthAttachment(&depth);
  begin(info);
}

void Frame::beginDepthStencil(const GpuImage& image, vk::AttachmentLoadOp load) const {
  vk::RenderingAttachmentInfo attachment(image.view(),
                                         vk::ImageLayout::eDepthStencilAttachmentOptimal);
  attachment.loadOp = load;
  attachment.storeOp = vk::AttachmentStoreOp::eStore;
  attachment.clearValue.depthStencil = vk::ClearDepthStencilValue(0.0f, 0);
  vk::RenderingInfo info({}, target.area(), 1);
  const vk::ImageAspectFlags aspects = image.description().aspect;
  if (aspects & vk::ImageAspectFlagBits::eDepth) info.setPDepthAttachment(&attachment);
  if (aspects & vk::ImageAspectFlagBits::eStencil) info.setPStencilAttachment(&attachment);
  begin(info);
}

void Frame::begin(const vk::RenderingInfo& info) const {
  commands.beginRendering(info);
  commands.setViewport(0, vk::Viewport(0, 0, float(target.width()), float(target.height()), 0, 1));
  commands.setScissor(0, target.area());
}

void Frame::drawTransparent() const {
  if (scene.transparentCount() == 0) return;
  commands.bindIndexBuffer(scene.transparentIndices().vk(), 0, vk::IndexType::eUint32);
  commands.drawIndexed(scene.transparentCount() * 3, 1, 0, 0, 0);
}

void Frame::dispatchPixels() const {
  commands.dispatch(divideUp(target.width(), 8u), divideUp(target.height(), 8u), 1);
}

}  // namespace oitlab
