// The exact image: every fragment in per-pixel linked lists (Yang et al. 2010), sorted in full
// whatever the depth of the pixel, blended in float32. Simple before fast: others are judged by it.
#include "reference/lists.h"

#include "method/method.h"
#include "util/error.h"

namespace oitlab::reference {

class Reference : public Method {
 public:
  void prepare(const Device& device, const GpuScene&, const Target& target,
               const Parameters& parameters) override {
    device_ = &device;
    pixels_ = std::uint64_t(target.width()) * target.height();
    capture_ = Pipeline::graphics(
        device, {.fragmentShader = "reference/capture.frag", .depthFormat = Target::depthFormat});
    resolve_ = Pipeline::compute(device, "reference/resolve.comp",
                                 {{"TARGET_FORMAT", formatName(target.format())}});
    runs_ = Buffer(device, memory_, "sort state", pixels_ * sizeof(std::uint32_t));
    heads_ = Buffer(device, memory_, "list heads", pixels_ * sizeof(std::uint32_t));
    counters_ = Buffer(device, memory_, "counters", sizeof(ListCounters));
    readback_ =
        Buffer(device, memory_, "counters readback", sizeof(ListCounters), BufferKind::readback);
    allocateNodes(std::uint64_t(double(pixels_) * parameters.real("initial_depth")) + 1);
  }

  void record(const Frame& frame) override {
    using Stage = vk::PipelineStageFlagBits2;
    ListPush push{frame.constants,
                  nodes_.address(),
                  heads_.address(),
                  counters_.address(),
                  runs_.address(),
                  capacity_,
                  0,
                  rounds_};
    frame.stage("clear", [&] {
      fillBuffer(frame.commands, heads_, LIST_END);
      fillBuffer(frame.commands, counters_, 0);
      frame.barrier(Stage::eTransfer, Stage::eFragmentShader);
    });
    frame.stage("capture", [&] {
      frame.renderDepthTested({}, [&] {
        capture_.bind(frame.commands, frame.bindings);
        capture_.push(frame.commands, push);
        frame.drawTransparent();
      });
      frame.barrier(Stage::eFragmentShader, Stage::eComputeShader);
    });
    frame.stage("resolve", [&] {
      resolve_.bind(frame.commands, frame.bindings);
      for (push.round = 0; push.round < rounds_; ++push.round) {
        resolve_.push(frame.commands, push);
        frame.dispatchPixels();
        frame.barrier(Stage::eComputeShader, Stage::eComputeShader | Stage::eTransfer);
      }
      frame.commands.copyBuffer(counters_.vk(), readback_.vk(),
                                vk::BufferCopy(0, 0, sizeof(ListCounters)));
      frame.barrier(Stage::eTransfer, Stage::eHost);
    });
  }

  Status status() override {
    const ListCounters counters = readback_.mapped<ListCounters>()[0];
    if (counters.fragments > capacity_) {
      // A little more than was counted, so that a slowly turning camera does not grow it every
      // frame.
      allocateNodes(counters.fragments + counters.fragments / 16ull);
      return {.recordAgain = true};
    }
    if (counters.unfinished > 0) {
      rounds_ *= 2;
      return {.recordAgain = true};
    }
    // Nothing is lost in silence, not even to a device that leaves loops early.
    if (counters.resolved != counters.fragments)
      fail<DeviceError>(
          "reference: {} fragments were captured and {} blended: {} does not carry out "
          "the shader's loops in full (a pixel may be too deep for it)",
          counters.fragments, counters.resolved, device_->info().name);
    return {.counters = {{"fragments", counters.fragments},
                         {"max_fragments_per_pixel", counters.deepest},
                         {"covered_pixels", counters.coveredPixels}}};
  }

 private:
  void allocateNodes(std::uint64_t nodes) {
    // Node indices and the fragment counter are 32 bits wide.
    if (nodes >= LIST_END)
      fail<DeviceError>(
          "reference: {} fragments are more than the 2^32 - 1 that its lists can name", nodes);
    nodes_ = Buffer();  // give the old one back first: both may not fit
    nodes_ = Buffer(*device_, memory_, "fragment nodes", nodes * sizeof(Node));
    capacity_ = std::uint32_t(nodes);
  }

  const Device* device_ = nullptr;
  std::uint64_t pixels_ = 0;
  std::uint32_t capacity_ = 0;  // nodes
  std::uint32_t rounds_ = 1;    // dispatches that the sort is spread over
  Pipeline capture_, resolve_;
  Buffer nodes_, heads_, runs_, counters_, readback_;
};

const RegisterMethod registered({
    .name = "reference",
    .summary = "exact: linked lists of every fragment, sorted in full, float32 colour, no limit",
    .source = "Yang, Hensley, Gruen, Thibieroz 2010 (lists); sorted by merging in place",
    .exact = true,
    .parameters = {real("initial_depth", 4.0, 0.0, 1024.0,
                        "fragments a pixel that memory is first made for; it grows as needed",
                        "fragments")},
    .features = {"fragmentStoresAndAtomics", "geometryShader"},  // gl_PrimitiveID in fragments
    .make = [] { return std::make_unique<Reference>(); },
});

}  // namespace oitlab::reference
