#include "source/hardware_source.h"

#include "source/program_contract.h"
#include "source/program_defines.h"
#include "source/state_size.h"
#include "util/check.h"
#include "util/error.h"

namespace oitlab {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access2 = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;

vk::PipelineColorBlendAttachmentState blendOf(int operation) {
  using Factor = vk::BlendFactor;
  if (operation == COMBINE_ADD) return additive();
  if (operation == COMBINE_ATTENUATE) return blending(Factor::eZero, Factor::eOneMinusSrcColor);
  return straightOver();
}

}  // namespace

HardwareSource::HardwareSource(const Device& device, const GpuScene& scene, const Target& target,
                               MemoryLedger& memory, const Options& options)
    : device_(device),
      scene_(scene),
      target_(target),
      memory_(memory),
      options_(options),
      states_(device, target, memory),
      samples_(device) {}

void HardwareSource::checkFeature(const char* feature, const char* why) const {
  if (!device_.info().has(feature))
    fail<DeviceError>("source=hardware needs {}, which {} lacks, {}; source=compute does without",
                      feature, device_.info().name, why);
}

FragmentPass HardwareSource::make(const FragmentProgram& program) {
  if (program.access == Access::exclusive && !options_.withoutInterlock)
    checkFeature("fragmentShaderPixelInterlock", "to give a pixel to one fragment at a time");
  if (program.access != Access::blended)
    checkFeature("fragmentStoresAndAtomics", "to store fragments from fragment shaders");
  if (program.needsId) checkFeature("geometryShader", "for primitive ids in fragment shaders");
  Pass pass{.program = program, .fragments = {}, .composite = {}, .sums = {}, .bindings = {}};
  Pipeline::Graphics description{.fragmentShader = "source/hardware.frag",
                                 .defines = programDefines(program),
                                 .depthFormat = Target::depthFormat};
  description.defines["HAS_ID"] = program.needsId ? "1" : "0";
  if (program.depthStencilFormat != vk::Format::eUndefined) {
    description.depthFormat = description.stencilFormat = program.depthStencilFormat;
    description.stencil = program.stencil;
  }
  if (program.access == Access::blended) addTargets(program, pass, description);
  if (program.access == Access::exclusive) addStates(program, description);
  pass.fragments = makeProgram(program, [&] { return Pipeline::graphics(device_, description); });
  if (pass.hasComposite()) pass.composite = makeComposite(program);
  passes_.push_back(std::move(pass));
  Pass& made = passes_.back();
  if (!made.sums.empty()) {
    std::vector<const GpuImage*> images;
    for (const GpuImage& image : made.sums) images.push_back(&image);
    made.bindings.emplace(device_, scene_, target_, images);
  }
  return {passes_.size() - 1};
}

void HardwareSource::addTargets(const FragmentProgram& program, Pass& pass,
                                Pipeline::Graphics& description) {
  if (program.isOnTarget()) {
    description.colorFormats = {vulkanFormat(target_.format())};
    description.blends = {blendOf(COMBINE_OVER)};
  }
  for (const FragmentSum& sum : program.sums) {
    using Usage = vk::ImageUsageFlagBits;
    pass.sums.emplace_back(
        device_, memory_,
        GpuImage::Description{sum.name, sum.format, target_.width(), target_.height(), 1,
                              Usage::eColorAttachment | Usage::eSampled});
    description.colorFormats.push_back(sum.format);
    description.blends.push_back(blendOf(sum.operation));
  }
  if (description.blends.size() > 1)
    checkFeature("independentBlend", "to combine several sums in different ways");
}

void HardwareSource::addStates(const FragmentProgram& program, Pipeline::Graphics& description) {
  if (!options_.withoutInterlock) description.defines["INTERLOCK"] = "1";
  states_.reserve(stateBytes(device_, program, description.fragmentShader, description.defines));
}

Pipeline HardwareSource::makeComposite(const FragmentProgram& program) const {
  return makeProgram(program, [&] {
    return Pipeline::graphics(device_, {.vertexShader = "common/fullscreen.vert",
                                        .fragmentShader = "source/composite.frag",
                                        .defines = programDefines(program),
                                        .colorFormats = {vulkanFormat(target_.format())},
                                        .depthFormat = Target::depthFormat,
                                        .depthTest = false,
                                        .blends = {premultipliedOver()}});
  });
}

std::uint64_t HardwareSource::begin(const Frame& frame, const Submission& submission) {
  submission_ = submission;
  samples_.reset(frame);
  counts_ = true;
  return states_.empty() ? frame.constants : states_.begin(frame);
}

void HardwareSource::addCounters(std::map<std::string, std::uint64_t>& counters) {
  for (const auto& [name, value] : samples_.counters()) counters[name] = value;
  if (const auto taken = states_.taken()) counters["fragments"] = *taken;
}

void HardwareSource::draw(const Frame& frame, const FragmentRun& run) const {
  if (!run.draw && submission_.indices == nullptr) {
    frame.drawTransparent();
    return;
  }
  const Buffer& indices =
      submission_.indices != nullptr ? *submission_.indices : scene_.transparentIndices();
  frame.commands.bindIndexBuffer(indices.vk(), 0, vk::IndexType::eUint32);
  if (run.draw)
    frame.commands.drawIndexedIndirect(run.draw, run.drawOffset, 1,
                                       sizeof(vk::DrawIndexedIndirectCommand));
  else
    frame.commands.drawIndexed(scene_.transparentCount() * 3, 1, 0, 0, 0);
}

void HardwareSource::runBytes(const Frame& frame, const std::string& stage, FragmentPass number,
                              std::span<const std::byte> push, const FragmentRun& run) {
  const Pass& pass = passes_.at(number.number);
  const auto recordPass = [&] { accumulate(frame, pass, push, run); };
  if (stage.empty())
    recordPass();
  else
    frame.stage(stage, recordPass);
  if (pass.hasComposite()) frame.stage("composite", [&] { composite(frame, pass, push); });
  if (pass.program.access == Access::exclusive && counts_ && frame.instrumented)
    frame.stage("count", [&] { states_.count(frame); });
  if (pass.program.access != Access::none) counts_ = false;
}

void HardwareSource::accumulate(const Frame& frame, const Pass& pass,
                                std::span<const std::byte> push, const FragmentRun& run) {
  const auto record = [&] {
    pass.fragments.bind(frame.commands, frame.bindings, push);
    if (run.depthStencil != nullptr)
      frame.commands.setStencilReference(vk::StencilFaceFlagBits::eFrontAndBack, 0);
    draw(frame, run);
  };
  if (pass.program.access == Access::none) {
    if (run.depthStencil != nullptr)
      frame.renderOnDepthStencil(*run.depthStencil, vk::AttachmentLoadOp::eLoad, record);
    else
      frame.renderDepthTested({}, record);
    return;
  }
  if (pass.program.access == Access::exclusive) {
    states_.open(frame);
    frame.renderDepthTested({}, record);
    return;
  }
  const auto recordCounted = [&] {
    if (counts_)
      samples_.count(frame, record);
    else
      record();
  };
  if (pass.program.isOnTarget()) {
    frame.renderOnTarget(recordCounted);
    return;
  }
  std::vector<vk::RenderingAttachmentInfo> attachments;
  for (std::size_t i = 0; i < pass.sums.size(); ++i) {
    pass.sums[i].transition(frame.commands, Layout::eUndefined, Layout::eColorAttachmentOptimal,
                            Stage::eAllCommands, Access2::eMemoryWrite,
                            Stage::eColorAttachmentOutput,
                            Access2::eColorAttachmentRead | Access2::eColorAttachmentWrite);
    const glm::vec4 v = pass.program.sums[i].initial;
    attachments.push_back(clearedAttachment(pass.sums[i], {v.x, v.y, v.z, v.w}));
  }
  frame.renderDepthTested(attachments, recordCounted);
}

void HardwareSource::composite(const Frame& frame, const Pass& pass,
                               std::span<const std::byte> push) const {
  if (pass.program.access == Access::exclusive)
    frame.barrier(Stage::eFragmentShader | Stage::eColorAttachmentOutput,
                  Stage::eFragmentShader | Stage::eComputeShader | Stage::eColorAttachmentOutput);
  for (const GpuImage& image : pass.sums)
    image.transition(frame.commands, Layout::eColorAttachmentOptimal,
                     Layout::eShaderReadOnlyOptimal, Stage::eColorAttachmentOutput,
                     Access2::eColorAttachmentWrite, Stage::eFragmentShader, Access2::eShaderRead);
  frame.renderOnTarget([&] {
    pass.composite.bind(frame.commands, pass.bindings ? pass.bindings->set() : frame.bindings,
                        push);
    frame.drawFullscreen();
  });
}

}  // namespace oitlab
