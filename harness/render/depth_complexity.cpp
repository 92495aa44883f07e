#include "render/depth_complexity.h"

#include "depth/count.h"
#include "source/compute_source.h"
#include "source/hardware_source.h"
#include "util/check.h"
#include "util/error.h"

namespace oitlab {
namespace {

/// A method, because a Renderer renders methods. It is not registered, because it makes no image.
class FragmentCounter : public Method {
 public:
  FragmentCounter(const Device& device, const GpuScene& scene, const Target& target,
                  bool byHardware)
      : source_(makeSource(device, scene, target, byHardware)),
        pass_(
            source_->make({.file = "depth/count.glsl", .access = Access::none, .needsId = false})),
        counts_(device, unlisted_, "fragment counts", bytesFor(target)),
        readback_(device, unlisted_, "counts readback", bytesFor(target), BufferKind::readback) {}

  bool usesComputeRasterizer() const override { return source_->usesComputeRasterizer(); }

  void record(const Frame& frame) override {
    using Stage = vk::PipelineStageFlagBits2;
    const CountPush push{source_->begin(frame), counts_.address()};
    fillBuffer(frame.commands, counts_, 0);
    frame.barrier(Stage::eTransfer, source_->stages());
    source_->run(frame, "count", pass_, push);
    frame.barrier(source_->stages(), Stage::eTransfer);
    frame.commands.copyBuffer(counts_.vk(), readback_.vk(), vk::BufferCopy(0, 0, counts_.bytes()));
    frame.barrier(Stage::eTransfer, Stage::eHost);
    source_->end(frame);
  }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    Status status;
    source_->addCounters(status.counters);  // fails where fragments were lost
    return status;
  }

  std::vector<std::uint32_t> counts() const {
    const auto mapped = readback_.mapped<std::uint32_t>();
    return {mapped.begin(), mapped.end()};
  }

 private:
  static std::uint64_t bytesFor(const Target& target) {
    return target.pixels() * sizeof(std::uint32_t);
  }

  std::unique_ptr<FragmentSource> makeSource(const Device& device, const GpuScene& scene,
                                             const Target& target, bool byHardware) {
    if (byHardware)
      return std::make_unique<HardwareSource>(device, scene, target, unlisted_,
                                              HardwareSource::Options{});
    return std::make_unique<ComputeSource>(device, scene, target, unlisted_,
                                           ComputeSource::Options{});
  }

  MemoryLedger unlisted_;
  std::unique_ptr<FragmentSource> source_;
  FragmentPass pass_;
  Buffer counts_, readback_;
};

}  // namespace

DepthComplexity::DepthComplexity(std::uint32_t w, std::uint32_t h, std::vector<std::uint32_t> c)
    : width(w), height(h), counts(std::move(c)) {
  OITLAB_CHECK_OP(counts.size(), ==, std::size_t(width) * height);
  for (const std::uint32_t count : counts) {
    total += count;
    covered += count > 0;
    peak = std::max(peak, count);
  }
  histogram.resize(std::size_t(peak) + 1);
  for (const std::uint32_t count : counts) ++histogram[count];
}

double DepthComplexity::meanOfAll() const {
  return counts.empty() ? 0 : double(total) / double(counts.size());
}

double DepthComplexity::meanOfCovered() const {
  return covered == 0 ? 0 : double(total) / double(covered);
}

DepthComplexity countFragments(Renderer& renderer, const Camera& camera, bool byHardware) {
  FragmentCounter counter(renderer.device(), renderer.scene(), renderer.target(), byHardware);
  renderer.render(counter, camera);
  return {renderer.target().width(), renderer.target().height(), counter.counts()};
}

}  // namespace oitlab
