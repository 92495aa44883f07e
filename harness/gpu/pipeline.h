#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/shader.h"

namespace oitlab {

/// Specialization constants: values of constant_id 0, 1, 2, ...
using Constants = std::vector<std::uint32_t>;

/// A graphics or compute pipeline: bind it, then draw or dispatch. This is a handle to a pipeline
/// that the device owns; the device must outlive it.
class Pipeline {
 public:
  Pipeline() = default;

  /// A compute pipeline from shaders/`path`. If `subgroupSize` is not 0 and the device has
  /// subgroupSizeControl, subgroups have this size and are full: the workgroup's width must be a
  /// multiple of it. With 0 the device chooses. Throws DeviceError when the driver does not make
  /// the pipeline; the message has the shader and `ifRefused`.
  static Pipeline compute(const Device& device, const std::string& path,
                          const Defines& defines = {}, const Constants& constants = {},
                          std::uint32_t subgroupSize = 0, const std::string& ifRefused = "");

  struct Graphics {
    std::string vertexShader = "common/scene.vert";
    std::string fragmentShader;
    Defines defines;  ///< for both shaders
    std::vector<vk::Format> colorFormats;
    vk::Format depthFormat = vk::Format::eUndefined;
    bool depthTest = true;  ///< ignored without a depth format
    bool depthWrite = false;
    /// Depth is reversed: by default a fragment passes if it is not farther than the stored depth.
    vk::CompareOp depthCompare = vk::CompareOp::eGreaterOrEqual;
    /// For a pass with a stencil (Frame::renderOnDepthStencil): the stencil test and what it
    /// writes, for both faces. By default every fragment passes and the stencil stays as it is. The
    /// reference value is set by setStencilReference() after bind().
    vk::Format stencilFormat = vk::Format::eUndefined;
    vk::StencilOpState stencil{vk::StencilOp::eKeep,
                               vk::StencilOp::eKeep,
                               vk::StencilOp::eKeep,
                               vk::CompareOp::eAlways,
                               0xff,
                               0xff,
                               0};
    std::vector<vk::PipelineColorBlendAttachmentState>
        blends;  ///< one per colour format; default: no blending
    /// Added to the message when the driver refuses the pipeline: what is unusual about it, and
    /// which parameter to change.
    std::string ifRefused;
  };
  /// Throws DeviceError when the driver does not make the pipeline; the message has the shaders and
  /// `ifRefused`.
  static Pipeline graphics(const Device& device, const Graphics& description);

  /// Binds the pipeline and the images of `set`, which is null for shaders that use no image.
  void bind(const Commands& commands, vk::DescriptorSet set) const;

  /// The same with push constants, a struct of at most Device::pushConstantBytes.
  void bind(const Commands& commands, vk::DescriptorSet set,
            std::span<const std::byte> push) const {
    bind(commands, set);
    commands.pushConstants<std::byte>(layout_, vk::ShaderStageFlagBits::eAll, 0, push);
  }
  template <typename Push>
  void bind(const Commands& commands, vk::DescriptorSet set, const Push& push) const {
    static_assert(sizeof(Push) <= Device::pushConstantBytes);
    bind(commands, set);
    commands.pushConstants<Push>(layout_, vk::ShaderStageFlagBits::eAll, 0, push);
  }

 private:
  vk::PipelineBindPoint bindPoint_ = vk::PipelineBindPoint::eCompute;
  vk::PipelineLayout layout_;
  vk::Pipeline pipeline_;
};

/// The message for a pipeline that `device` refuses for the reason `cause`. Paths of `shaders` are
/// relative to the folder shaders/.
std::string pipelineRefusal(const std::string& device, const std::vector<std::string>& shaders,
                            const Defines& defines, const Constants& constants,
                            const std::string& cause, const std::string& ifRefused);

/// source * `sourceFactor` + destination * `destinationFactor`, for colour and alpha alike.
vk::PipelineColorBlendAttachmentState blending(vk::BlendFactor sourceFactor,
                                               vk::BlendFactor destinationFactor);

/// source + destination.
vk::PipelineColorBlendAttachmentState additive();

/// Puts a premultiplied colour over the destination: source + destination * (1 - source alpha).
vk::PipelineColorBlendAttachmentState premultipliedOver();

/// Puts a colour that is not premultiplied over the destination: back-to-front blending.
vk::PipelineColorBlendAttachmentState straightOver();

}  // namespace oitlab
