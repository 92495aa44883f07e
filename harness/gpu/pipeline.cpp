#include "gpu/pipeline.h"

#include "gpu/debug_names.h"
#include "gpu/pipeline_cache.h"
#include "gpu/pipeline_statistics.h"
#include "util/error.h"

namespace oitlab {
namespace {

using Words = std::vector<std::uint32_t>;

vk::raii::ShaderModule makeModule(const Device& device, const Words& words) {
  return {device.vk(), vk::ShaderModuleCreateInfo({}, words)};
}

/// The name that capture tools show: "wboit/accumulate.frag WEIGHT=7".
std::string labelOf(const std::string& path, const Defines& defines, const Constants& constants) {
  std::string label = path;
  for (const auto& [name, value] : defines) label += fmt::format(" {}={}", name, value);
  for (std::size_t i = 0; i < constants.size(); ++i)
    label += fmt::format(" constant {}={}", i, constants[i]);
  return label;
}

vk::raii::Pipeline makeCompute(const Device& device, const Words& words, const Constants& constants,
                               std::uint32_t subgroupSize) {
  const auto module = makeModule(device, words);
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i) entries.emplace_back(i, i * 4, 4);
  vk::SpecializationInfo specialization;
  specialization.setMapEntries(entries);
  specialization.setData<std::uint32_t>(constants);
  vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo required(subgroupSize);
  vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                          &specialization);
  if (subgroupSize != 0 && device.info().has("subgroupSizeControl")) stage.setPNext(&required);
  // Then no subgroup has inactive lanes, and lanes are consecutive invocations of the workgroup.
  if (subgroupSize != 0 && device.info().has("computeFullSubgroups"))
    stage.setFlags(vk::PipelineShaderStageCreateFlagBits::eRequireFullSubgroups);
  vk::ComputePipelineCreateInfo info({}, stage, device.pipelineLayout());
  if (device.hasPipelineStatistics())
    info.flags |= vk::PipelineCreateFlagBits::eCaptureStatisticsKHR;
  return {device.vk(), nullptr, info};
}

vk::raii::Pipeline makeGraphics(const Device& device, const Words& vertexWords,
                                const Words& fragmentWords, const Pipeline::Graphics& description) {
  const auto vertex = makeModule(device, vertexWords);
  const auto fragment = makeModule(device, fragmentWords);
  const std::array stages = {
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *vertex, "main"),
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, *fragment, "main")};
  const vk::PipelineVertexInputStateCreateInfo vertexInput;  // vertices are read by address
  const vk::PipelineInputAssemblyStateCreateInfo assembly({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.lineWidth = 1.0f;
  const vk::PipelineMultisampleStateCreateInfo multisample({}, vk::SampleCountFlagBits::e1);
  const bool depth = description.depthFormat != vk::Format::eUndefined;
  const bool stencil = description.stencilFormat != vk::Format::eUndefined;
  const vk::PipelineDepthStencilStateCreateInfo depthStencil(
      {}, depth && description.depthTest, description.depthWrite, description.depthCompare, false,
      stencil, description.stencil, description.stencil);
  auto blends = description.blends;
  using Component = vk::ColorComponentFlagBits;
  while (blends.size() < description.colorFormats.size())
    blends.emplace_back().colorWriteMask =
        Component::eR | Component::eG | Component::eB | Component::eA;
  vk::PipelineColorBlendStateCreateInfo blend;
  blend.setAttachments(blends);
  std::vector dynamics = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  if (stencil) dynamics.push_back(vk::DynamicState::eStencilReference);
  const vk::PipelineDynamicStateCreateInfo dynamic({}, dynamics);
  vk::PipelineRenderingCreateInfo rendering;
  rendering.setColorAttachmentFormats(description.colorFormats);
  rendering.setDepthAttachmentFormat(description.depthFormat);
  rendering.setStencilAttachmentFormat(description.stencilFormat);
  vk::GraphicsPipelineCreateInfo info({}, stages, &vertexInput, &assembly, nullptr, &viewport,
                                      &raster, &multisample, &depthStencil, &blend, &dynamic,
                                      device.pipelineLayout());
  info.setPNext(&rendering);
  return {device.vk(), nullptr, info};
}

}  // namespace

vk::PipelineColorBlendAttachmentState blending(vk::BlendFactor sourceFactor,
                                               vk::BlendFactor destinationFactor) {
  using Component = vk::ColorComponentFlagBits;
  const auto all = Component::eR | Component::eG | Component::eB | Component::eA;
  return {VK_TRUE,      sourceFactor,      destinationFactor, vk::BlendOp::eAdd,
          sourceFactor, destinationFactor, vk::BlendOp::eAdd, all};
}

vk::PipelineColorBlendAttachmentState additive() {
  return blending(vk::BlendFactor::eOne, vk::BlendFactor::eOne);
}

vk::PipelineColorBlendAttachmentState premultipliedOver() {
  return blending(vk::BlendFactor::eOne, vk::BlendFactor::eOneMinusSrcAlpha);
}

vk::PipelineColorBlendAttachmentState straightOver() {
  auto state = blending(vk::BlendFactor::eSrcAlpha, vk::BlendFactor::eOneMinusSrcAlpha);
  state.srcAlphaBlendFactor = vk::BlendFactor::eOne;
  return state;
}

std::string pipelineRefusal(const std::string& device, const std::vector<std::string>& shaders,
                            const Defines& defines, const Constants& constants,
                            const std::string& cause, const std::string& ifRefused) {
  std::string text = fmt::format("{} makes no pipeline of shaders/{}", device,
                                 fmt::join(shaders, " and shaders/"));
  std::vector<std::string> with;
  for (const auto& [name, value] : defines) with.push_back(fmt::format("{}={}", name, value));
  for (std::size_t i = 0; i < constants.size(); ++i)
    with.push_back(fmt::format("constant {}={}", i, constants[i]));
  if (!with.empty()) text += fmt::format(" ({})", fmt::join(with, ", "));
  text += ": " + cause;
  return ifRefused.empty() ? text : text + "; " + ifRefused;
}

Pipeline Pipeline::compute(const Device& device, const std::string& path, const Defines& defines,
                           const Constants& constants, std::uint32_t subgroupSize,
                           const std::string& ifRefused) {
  const Words words = device.shaders().compile(path, defines);
  Pipeline pipeline;
  pipeline.bindPoint_ = vk::PipelineBindPoint::eCompute;
  pipeline.layout_ = device.pipelineLayout();
  const auto key = PipelineKey().add(words).add(constants).add(subgroupSize);
  pipeline.pipeline_ = device.pipelines().findOrMake(key, [&] {
    try {
      auto made = makeCompute(device, words, constants, subgroupSize);
      nameObject(device, *made, labelOf(path, defines, constants));
      printPipelineStatistics(device, *made, path);
      return made;
    } catch (const vk::SystemError& error) {
      throw DeviceError(
          pipelineRefusal(device.info().name, {path}, defines, constants, error.what(), ifRefused));
    }
  });
  return pipeline;
}

Pipeline Pipeline::graphics(const Device& device, const Graphics& description) {
  const Words vertex = device.shaders().compile(description.vertexShader, description.defines);
  const Words fragment = device.shaders().compile(description.fragmentShader, description.defines);
  const auto key = PipelineKey()
                       .add(vertex)
                       .add(fragment)
                       .add(description.colorFormats)
                       .add(description.depthFormat)
                       .add(description.depthTest)
                       .add(description.depthWrite)
                       .add(description.depthCompare)
                       .add(description.stencilFormat)
                       .add(description.stencil)
                       .add(description.blends);
  Pipeline pipeline;
  pipeline.bindPoint_ = vk::PipelineBindPoint::eGraphics;
  pipeline.layout_ = device.pipelineLayout();
  pipeline.pipeline_ = device.pipelines().findOrMake(key, [&] {
    try {
      auto made = makeGraphics(device, vertex, fragment, description);
      nameObject(device, *made, labelOf(description.fragmentShader, description.defines, {}));
      return made;
    } catch (const vk::SystemError& error) {
      throw DeviceError(pipelineRefusal(
          device.info().name, {description.vertexShader, description.fragmentShader},
          description.defines, {}, error.what(), description.ifRefused));
    }
  });
  return pipeline;
}

void Pipeline::bind(const Commands& commands, vk::DescriptorSet set) const {
  commands.bindPipeline(bindPoint_, pipeline_);
  if (set) commands.bindDescriptorSets(bindPoint_, layout_, 0, set, nullptr);
}

}  // namespace oitlab
