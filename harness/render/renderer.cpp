#include "render/renderer.h"

#include "common/frame_types.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;

/// A method that enlarges its buffers to the counted size needs two recordings. More are allowed,
/// because a counter may show only part of the need, but a limit ends the loop.
constexpr int maxRecordings = 12;

/// The push constants of background.comp.
struct BackgroundPush {
  glm::vec4 color;
  std::uint32_t firstRow;  // of workgroups
};

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

Renderer::Renderer(const Device& device, const GpuScene& scene, const Target& target)
    : device_(device),
      scene_(scene),
      target_(target),
      timer_(device),
      opaque_(device, scene, target, OpaquePass::DepthOf::hardware),
      background_(Pipeline::compute(device, "common/background.comp",
                                    {{"TARGET_FORMAT", formatName(target.format())}})),
      constants_(device, memory_, "frame constants", sizeof(FrameConstants), BufferKind::upload),
      commands_(device.makeCommandBuffer()),
      fence_(device.vk(), vk::FenceCreateInfo()) {}

std::unique_ptr<Method> Renderer::make(const MethodInfo& info, const Parameters& parameters) const {
  return info.makeFor(device_, scene_, target_, parameters);
}

FrameResult Renderer::render(Method& method, const Camera& camera, bool instrumented) {
  for (int recording = 1; recording <= maxRecordings; ++recording) {
    Status status;
    FrameResult result = renderOnce(method, camera, instrumented, status);
    if (status.recordAgain) continue;
    result.recordings = recording;
    result.counters = std::move(status.counters);
    return result;
  }
  fail<DeviceError>("the method asked for a new recording {} times in a row", maxRecordings);
}

FrameResult Renderer::renderOnce(Method& method, const Camera& camera, bool instrumented,
                                 Status& status) {
  const auto start = std::chrono::steady_clock::now();
  const float aspect = float(target_.width()) / float(target_.height());
  FrameConstants constants{};
  constants.viewProjection = camera.projectionMatrix(aspect) * camera.viewMatrix();
  constants.size = {target_.width(), target_.height()};
  constants.vertices = scene_.vertices().address();
  constants.materials = scene_.materials().address();
  constants.transparentIds = scene_.transparentIds().address();
  constants_.mapped<FrameConstants>()[0] = constants;

  const OpaquePass& opaque = opaquePassOf(method);
  FrameResult result;
  try {
    commands_.reset();
    commands_.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    Frame frame{
        device_,   commands_,    scene_, target_, camera, opaque.bindings(), constants_.address(),
        constants, instrumented, timer_};
    frame.computeRasterizer = method.usesComputeRasterizer();
    timer_.begin(commands_, instrumented);
    frame.stage("opaque", [&] {
      // lavapipe (Mesa 22.3) crashes when a clear, a dispatch and a render pass follow each other.
      if (scene_.opaqueCount() > 0 || !depthCleared_ || device_.info().isCpu()) {
        opaque.record(frame);
        return;
      }
      // In an instrumented frame stages are timed separately, so they must not overlap.
      if (method.usesComputeRasterizer() && !instrumented) {
        frame.fillTarget = [&](std::uint32_t part) { recordBackground(frame, part); };
        return;
      }
      for (std::uint32_t part = 0; part < Frame::targetParts; ++part) recordBackground(frame, part);
      target_.color().transition(commands_, Layout::eGeneral, Layout::eGeneral,
                                 Stage::eComputeShader, Access::eShaderStorageWrite,
                                 Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite);
    });
    method.record(frame);
    timer_.end(commands_);
    commands_.end();
    device_.vk().resetFences(*fence_);
    device_.submit(commands_, *fence_);
    result.cpuMs = millisecondsSince(start);
    device_.wait(*fence_);
    depthCleared_ = true;
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("{} failed while working: {}", device_.info().name, error.what());
  }
  FrameTimer::Reading reading = timer_.read();
  result.frameMs = reading.frameMs;
  result.stageMs = std::move(reading.stageMs);
  status = method.status();
  return result;
}

const OpaquePass& Renderer::opaquePassOf(const Method& method) {
  if (!method.usesComputeRasterizer()) return opaque_;
  if (!opaqueOfCompute_)
    opaqueOfCompute_.emplace(device_, scene_, target_, OpaquePass::DepthOf::computeRasterizer);
  return *opaqueOfCompute_;
}

// In a scene without opaque surfaces the depth is infinitely far everywhere. The first frame clears
// it, and it stays so, because methods read it and do not write it. A compute shader fills the
// colour: clears go through the rasterizer, and on GPUs with a slow rasterizer they take longer
// than a method.
void Renderer::recordBackground(const Frame& frame, std::uint32_t part) const {
  if (part == 0)
    target_.color().transition(frame.commands, Layout::eUndefined, Layout::eGeneral,
                               Stage::eAllCommands, Access::eMemoryWrite, Stage::eComputeShader,
                               Access::eShaderStorageWrite);
  constexpr std::uint32_t groupSize = 32;  // pixels on a side, of background.comp
  const std::uint32_t rows = divideUp(target_.height(), groupSize);
  const std::uint32_t first = rows * part / Frame::targetParts;
  const std::uint32_t end = rows * (part + 1) / Frame::targetParts;
  if (first == end) return;
  frame.bind(background_, BackgroundPush{backgroundColor, first});
  frame.commands.dispatch(divideUp(target_.width(), groupSize), end - first, 1);
}

std::map<std::string, std::uint64_t> Renderer::memoryByBuffer(const Method& method) const {
  std::map<std::string, std::uint64_t> buffers;
  auto add = [&](const std::string& prefix, const MemoryLedger& ledger) {
    for (const auto& [name, bytes] : ledger.byName()) buffers[prefix + name] += bytes;
  };
  add("method: ", method.memory());
  add("scene: ", scene_.memory());
  add("harness: ", target_.memory());
  add("harness: ", memory_);
  if (method.usesComputeRasterizer() && opaqueOfCompute_)
    add("harness: ", opaqueOfCompute_->memory());
  return buffers;
}

}  // namespace oitlab
