// Hardware alpha blending, the baseline of all measurements. It is exact only where triangles
// happen to be submitted back to front.
#include "blend/sort_types.h"

#include "frame/sample_counter.h"
#include "gpu/radix_sort.h"
#include "method/method.h"
#include "util/rounding.h"

namespace oitlab::blend {

/// Sorts a scene's triangles on the device, back to front by the distance of their centroids.
/// Triangles at equal distances stay in the order of submission.
class CentroidSort {
 public:
  /// The scene must have at least one transparent triangle.
  CentroidSort(const Device& device, MemoryLedger& memory, const GpuScene& scene)
      : count_(scene.transparentCount()),
        keys_(Pipeline::compute(device, "blend/centroid_keys.comp")),
        gather_(Pipeline::compute(device, "blend/gather_indices.comp")),
        sort_(device, memory, count_),
        indices_(device, memory, "sorted indices", 12ull * count_) {}

  /// Writes the vertex indices of the sorted triangles to indices().
  void record(const Frame& frame) const {
    using Stage = vk::PipelineStageFlagBits2;
    const CentroidPush push{.frame = frame.constants,
                            .submitted = frame.scene.transparentIndices().address(),
                            .sorted = indices_.address(),
                            .keys = sort_.keys().address(),
                            .values = sort_.values().address(),
                            .eye = frame.camera.eye,
                            .count = count_};
    const auto step = [&](const Pipeline& pipeline) {
      frame.bind(pipeline, push);
      frame.commands.dispatch(divideUp(count_, std::uint32_t(SORT_BLOCK)), 1, 1);
    };
    step(keys_);
    frame.barrier(Stage::eComputeShader, Stage::eComputeShader);
    sort_.record(frame.commands);
    step(gather_);
    frame.barrier(Stage::eComputeShader, Stage::eIndexInput);
  }

  const Buffer& indices() const { return indices_; }

 private:
  std::uint32_t count_;  // triangles
  Pipeline keys_, gather_;
  RadixSort sort_;
  Buffer indices_;
};

class Blend : public Method {
 public:
  explicit Blend(const MethodContext& context)
      : pipeline_(Pipeline::graphics(context.device,
                                     {.fragmentShader = "blend/blend.frag",
                                      .colorFormats = {vulkanFormat(context.target.format())},
                                      .depthFormat = Target::depthFormat,
                                      .blends = {straightOver()}})),
        samples_(context.device) {
    if (context.parameters.choice("order") == "sorted" && context.scene.transparentCount() > 0)
      sort_.emplace(context.device, context.memory, context.scene);
  }

  void record(const Frame& frame) override {
    // In every frame, even if the camera does not move, as an application with a moving one would.
    if (sort_) frame.stage("sort", [&] { sort_->record(frame); });
    samples_.reset(frame);
    frame.stage("blend", [&] {
      frame.renderOnTarget([&] {
        samples_.count(frame, [&] {
          frame.bind(pipeline_, frame.constants);
          if (sort_) {
            frame.commands.bindIndexBuffer(sort_->indices().vk(), 0, vk::IndexType::eUint32);
            frame.commands.drawIndexed(frame.scene.transparentCount() * 3, 1, 0, 0, 0);
          } else {
            frame.drawTransparent();
          }
        });
      });
    });
  }

  Status status() override { return {.counters = samples_.counters()}; }

 private:
  Pipeline pipeline_;
  std::optional<CentroidSort> sort_;
  SampleCounter samples_;
};

const RegisterMethod registered({
    .name = "blend",
    .summary = "hardware alpha blending: fast, and wrong where triangles overlap out of order",
    .source = "Porter and Duff 1984; fixed-function blending",
    .exact = false,
    .parameters = {choice("order", {"submission", "sorted"},
                          "submission: as the scene lists triangles; sorted: back to front by "
                          "distance of the centroid, sorted on the device in every frame")},
    .make = makeMethod<Blend>,
});

}  // namespace oitlab::blend
