#include "render/depth_complexity.h"

#include "depth/count.h"
#include "util/check.h"
#include "util/error.h"

namespace oitlab {
namespace {

/// A method, because a Renderer renders methods. It is not registered, because it makes no image.
class FragmentCounter : public Method {
 public:
  FragmentCounter(const Device& device, const Target& target)
      : pipeline_(Pipeline::graphics(
            device, {.fragmentShader = "depth/count.frag", .depthFormat = Target::depthFormat})),
        counts_(device, unlisted_, "fragment counts", bytesFor(target)),
        readback_(device, unlisted_, "counts readback", bytesFor(target), BufferKind::readback) {}

  void record(const Frame& frame) override {
    using Stage = vk::PipelineStageFlagBits2;
    fillBuffer(frame.commands, counts_, 0);
    frame.barrier(Stage::eTransfer, Stage::eFragmentShader);
    frame.renderDepthTested({}, [&] {
      frame.bind(pipeline_, CountPush{frame.constants, counts_.address()});
      frame.drawTransparent();
    });
    frame.barrier(Stage::eFragmentShader, Stage::eTransfer);
    frame.commands.copyBuffer(counts_.vk(), readback_.vk(), vk::BufferCopy(0, 0, counts_.bytes()));
    frame.barrier(Stage::eTransfer, Stage::eHost);
  }

  Status status() override { return {}; }

  std::vector<std::uint32_t> counts() const {
    const auto mapped = readback_.mapped<std::uint32_t>();
    return {mapped.begin(), mapped.end()};
  }

 private:
  static std::uint64_t bytesFor(const Target& target) {
    return target.pixels() * sizeof(std::uint32_t);
  }

  MemoryLedger unlisted_;
  Pipeline pipeline_;
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

DepthComplexity countFragments(Renderer& renderer, const Camera& camera) {
  const Device& device = renderer.device();
  if (!device.info().has("fragmentStoresAndAtomics"))
    fail<DeviceError>("fragments cannot be counted on {}: it lacks fragmentStoresAndAtomics",
                      device.info().name);
  FragmentCounter counter(device, renderer.target());
  renderer.render(counter, camera);
  return {renderer.target().width(), renderer.target().height(), counter.counts()};
}

}  // namespace oitlab
