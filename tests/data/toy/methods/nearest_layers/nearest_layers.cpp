// A k-buffer, as methods/README.md describes it. A test adds it to the program.
#include "method/make_source.h"

namespace oitlab::nearest_layers {

class NearestLayers : public Method {
 public:
  explicit NearestLayers(const MethodContext& context)
      : source_(makeSource(context)),
        pass_(source_->make(
            {.file = "nearest_layers/nearest.glsl",
             .access = Access::exclusive,
             .defines = {{"KEPT", std::to_string(context.parameters.integer("k"))}}})) {}

  bool finishesTarget() const override { return source_->finishesTarget(); }

  void record(const Frame& frame) override {
    const std::uint64_t push = source_->begin(frame);
    source_->run(frame, "nearest", pass_, push);
    source_->end(frame);
  }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    Status status;
    source_->addCounters(status.counters);
    return status;
  }

 private:
  std::unique_ptr<FragmentSource> source_;
  FragmentPass pass_;
};

const RegisterMethod registered({
    .name = "nearest_layers",
    .summary = "a toy: the k nearest layers of each pixel, the rest dropped",
    .source = "methods/README.md",
    .exact = false,
    .parameters = {integer("k", 4, 1, 8, "layers that a pixel keeps", "fragments")},
    .takesFragments = true,
    .make = makeMethod<NearestLayers>,
});

}  // namespace oitlab::nearest_layers
