#pragma once

#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/shader.h"

namespace oitlab {

/// Specialization constants: values of constant_id 0, 1, 2, ...
using Constants = std::vector<std::uint32_t>;

/// A pipeline of either kind. Bind, then draw or dispatch. A handle: the device owns what is
/// behind it, and must outlive it.
class Pipeline {
 public:
  Pipeline() = default;

  /// A compute pipeline from shaders/`path`. `subgroupSize` (0 = the device's choice) is required
  /// through subgroupSizeControl where the device has it, and subgroups are full: the workgroup's
  /// width must be a multiple of it. Throws DeviceError, with the shader and `ifRefused`, where the
  /// driver makes none.
  static Pipeline compute(const Device& device, const std::string& path,
                          const Defines& defines = {}, const Constants& constants = {},
                          std::uint32_t subgroupSize = 0, const std::string& ifRefused = "");

  struct Graphics {
    std::string vertexShader = "common/scene.vert";
    std::string fragmentShader;
    Defines defines;  ///< for both shaders
    std::vector<vk::Format> colorFormats;
    vk::Format depthFormat = vk::Format::eUndefined;
    bool depthTest = true;  ///< where there is a depth format
    bool depthWrite = false;
    /// Reversed depth: a fragment survives where it is as near as the stored depth or nearer.
    vk::CompareOp depthCompare = vk::CompareOp::eGreaterOrEqual;
    /// Of a pass that has a stencil (Frame::renderOnDepthStencil): the test and what it writes, for
    /// both faces; by default it lets all pass and keeps what is there. The reference value is set
    /// by setStencilReference() after bind().
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
    /// What to say beside the driver's reason where it refuses the pipeline: what is unusual about
    /// it, and what to ask for instead.
    std::string ifRefused;
  };
  /// Throws DeviceError, with the shaders and `ifRefused`, where the driver makes none.
  static Pipeline graphics(const Device& device, const Graphics& description);

  /// Binds it with the images of `set`; null for shaders that touch no image.
  void bind(const Commands& commands, vk::DescriptorSet set) const;

  /// The same, with push constants: a struct of at most Device::pushConstantBytes.
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

/// The message for a pipeline that `device` refuses for `cause`: `shaders` are relative to
/// shaders/.
std::string pipelineRefusal(const std::string& device, const std::vector<std::string>& shaders,
                            const Defines& defines, const Constants& constants,
                            const std::string& cause, const std::string& ifRefused);

/// source * `sourceFactor` + destination * `destinationFactor`, for colour and alpha alike.
vk::PipelineColorBlendAttachmentState blending(vk::BlendFactor sourceFactor,
                                               vk::BlendFactor destinationFactor);

/// source + destination.
vk::PipelineColorBlendAttachmentState additive();

/// Front-to-back result over what is there: source + destination * (1 - source alpha).
vk::PipelineColorBlendAttachmentState premultipliedOver();

/// Back-to-front `over` of colours that are not premultiplied.
vk::PipelineColorBlendAttachmentState straightOver();

}  // namespace oitlab
