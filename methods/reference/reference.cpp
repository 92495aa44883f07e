// The exact image: all fragments are in per-pixel linked lists (Yang et al. 2010), completely
// sorted for every number of layers, and blended in float32. It is simple and not fast, because
// other methods are compared with it.
#include "reference/lists.h"

#include "gpu/counters_buffer.h"
#include "method/make_source.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab::reference {

class Reference : public Method {
 public:
  explicit Reference(const MethodContext& context)
      : device_(context.device),
        memory_(context.memory),
        source_(makeSource(context)),
        capture_(source_->make({.file = "reference/capture.glsl", .access = Access::none})),
        resolve_(Pipeline::compute(device_, "reference/resolve.comp",
                                   {{"TARGET_FORMAT", formatName(context.target.format())}})),
        heads_(device_, memory_, "list heads", context.target.pixels() * sizeof(std::uint32_t)),
        runs_(device_, memory_, "sort state", context.target.pixels() * sizeof(std::uint32_t)),
        counters_(device_, memory_, "counters", sizeof(ListCounters)) {
    const double depth = context.parameters.real("initial_depth");
    allocateNodes(std::uint64_t(double(context.target.pixels()) * depth) + 1);
  }

  bool usesComputeRasterizer() const override { return source_->usesComputeRasterizer(); }

  void record(const Frame& frame) override {
    using Stage = vk::PipelineStageFlagBits2;
    ListPush push{source_->begin(frame),
                  nodes_.address(),
                  heads_.address(),
                  counters_.address(),
                  runs_.address(),
                  capacity_,
                  0,
                  rounds_};
    frame.stage("clear", [&] {
      fillBuffer(frame.commands, heads_, LIST_END);
      fillBuffer(frame.commands, counters_.buffer(), 0);
      frame.barrier(Stage::eTransfer, source_->stages());
    });
    source_->run(frame, "capture", capture_, push);
    frame.barrier(source_->stages(), Stage::eComputeShader);
    frame.stage("resolve", [&] {
      for (push.round = 0; push.round < rounds_; ++push.round) {
        if (push.round > 0) frame.barrier(Stage::eComputeShader, Stage::eComputeShader);
        frame.bind(resolve_, push);
        frame.dispatchPixels();
      }
      recordReadback(frame.commands, {&counters_});
    });
    source_->end(frame);
  }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    const ListCounters counters = counters_.read<ListCounters>();
    if (counters.fragments > capacity_) {
      allocateNodes(withSlack(counters.fragments));
      return {.recordAgain = true};
    }
    if (counters.unfinished > 0) {
      rounds_ *= 2;
      return {.recordAgain = true};
    }
    // A lost fragment is an error, even if the reason is a device that ends loops early.
    if (counters.resolved != counters.fragments)
      fail<DeviceError>(
          "reference: {} fragments were captured and {} blended: {} does not carry out "
          "the shader's loops in full (a pixel may be too deep for it)",
          counters.fragments, counters.resolved, device_.info().name);
    Status status;
    source_->addCounters(status.counters);
    status.counters["fragments"] = counters.fragments;
    status.counters["max_fragments_per_pixel"] = counters.deepest;
    status.counters["covered_pixels"] = counters.coveredPixels;
    return status;
  }

 private:
  void allocateNodes(std::uint64_t nodes) {
    // Node indices and the fragment counter are 32 bits wide.
    if (nodes >= LIST_END)
      fail<DeviceError>(
          "reference: {} fragments are more than the 2^32 - 1 that its lists can name", nodes);
    nodes_ = Buffer();  // free the old one first: there may not be room for both
    nodes_ = Buffer(device_, memory_, "fragment nodes", nodes * sizeof(Node));
    capacity_ = std::uint32_t(nodes);
  }

  const Device& device_;
  MemoryLedger& memory_;
  std::uint32_t capacity_ = 0;  // nodes
  std::uint32_t rounds_ = 1;    // dispatches that the sort is spread over
  std::unique_ptr<FragmentSource> source_;
  FragmentPass capture_;
  Pipeline resolve_;
  Buffer nodes_, heads_, runs_;
  CountersBuffer counters_;
};

const RegisterMethod registered({
    .name = "reference",
    .summary = "exact: linked lists of every fragment, sorted in full, float32 colour, no limit",
    .source = "Yang, Hensley, Gruen, Thibieroz 2010 (lists); sorted by merging in place",
    .exact = true,
    .parameters = {real("initial_depth", 4.0, 0.0, 1024.0,
                        "fragments a pixel that memory is first made for; it grows as needed",
                        "fragments")},
    .takesFragments = true,
    .make = makeMethod<Reference>,
});

}  // namespace oitlab::reference
