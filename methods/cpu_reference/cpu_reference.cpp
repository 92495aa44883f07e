// The CPU renderer as a method. Its image is uploaded, so that it can be compared like any other.
// Its GPU time is only that of the upload, so it does not compete in speed.
#include <glm/gtc/packing.hpp>

#include "cpu_renderer.h"
#include "method/method.h"

namespace oitlab::cpu_reference {
namespace {

std::uint64_t bytesPerChannel(TargetFormat format) {
  return format == TargetFormat::rgba32f ? 4 : format == TargetFormat::rgba16f ? 2 : 1;
}

void store(double value, TargetFormat format, std::byte* to) {
  switch (format) {
    case TargetFormat::rgba32f: {
      const float number = float(value);
      std::memcpy(to, &number, sizeof number);
      break;
    }
    case TargetFormat::rgba16f: {
      const std::uint16_t half = glm::packHalf1x16(float(value));
      std::memcpy(to, &half, sizeof half);
      break;
    }
    case TargetFormat::rgba8:
      *to = std::byte(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
      break;
  }
}

bool sameView(const Camera& a, const Camera& b) {
  return std::tie(a.eye, a.target, a.up, a.fovY, a.near) ==
         std::tie(b.eye, b.target, b.up, b.fovY, b.near);
}

}  // namespace

class CpuReference : public Method {
 public:
  explicit CpuReference(const MethodContext& context)
      : atlases_(buildAtlases(context.scene.scene())),
        pixels_(context.device, context.memory, "picture",
                context.target.pixels() * 4 * bytesPerChannel(context.target.format()),
                BufferKind::upload) {}

  void record(const Frame& frame) override {
    if (!renderedFor_ || !sameView(*renderedFor_, frame.camera)) renderPicture(frame);
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    const GpuImage& color = frame.target.color();
    frame.stage("upload", [&] {
      // The whole opaque image is overwritten.
      color.transition(frame.commands, Layout::eUndefined, Layout::eTransferDstOptimal,
                       Stage::eAllCommands, Access::eMemoryWrite, Stage::eCopy,
                       Access::eTransferWrite);
      const vk::BufferImageCopy copy(
          0, 0, 0, vk::ImageSubresourceLayers(vk::ImageAspectFlagBits::eColor, 0, 0, 1),
          vk::Offset3D(), vk::Extent3D(frame.target.width(), frame.target.height(), 1));
      frame.commands.copyBufferToImage(pixels_.vk(), color.vk(), Layout::eTransferDstOptimal, copy);
      color.transition(frame.commands, Layout::eTransferDstOptimal, Layout::eGeneral, Stage::eCopy,
                       Access::eTransferWrite, Stage::eAllCommands,
                       Access::eMemoryRead | Access::eMemoryWrite);
    });
  }

  Status status() override { return {.counters = counters_}; }

 private:
  void renderPicture(const Frame& frame) {
    const auto start = std::chrono::steady_clock::now();
    const CpuImage image = renderOnCpu(frame.scene.scene(), atlases_, frame.camera,
                                       int(frame.target.width()), int(frame.target.height()));
    const TargetFormat format = frame.target.format();
    std::byte* to = pixels_.mapped<std::byte>().data();
    for (const glm::dvec4& color : image.color)
      for (int i = 0; i < 4; ++i, to += bytesPerChannel(format)) store(color[i], format, to);
    renderedFor_ = frame.camera;
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    counters_ = {{"fragments", image.fragmentCount()},
                 {"max_fragments_per_pixel", image.maxFragmentsPerPixel()},
                 {"covered_pixels", image.coveredPixels()},
                 {"edge_pixels", image.pixelsInDoubt(doubt::edge)},
                 {"depth_order_pixels", image.pixelsInDoubt(doubt::depthOrder)},
                 {"cutoff_pixels", image.pixelsInDoubt(doubt::cutoff)},
                 {"cpu_ms", std::uint64_t(std::llround(took.count()))}};
  }

  SceneAtlases atlases_;
  Buffer pixels_;
  std::optional<Camera> renderedFor_;
  std::map<std::string, std::uint64_t> counters_;
};

const RegisterMethod registered({
    .name = "cpu_reference",
    .summary = "exact, on the CPU in double precision; its GPU time is only that of the upload",
    .source = "not a published method: ground truth for the tests; counter cpu_ms has its time",
    .exact = true,
    .make = makeMethod<CpuReference>,
});

}  // namespace oitlab::cpu_reference
