// Alpha blending, the baseline of all measurements. It is exact only where triangles happen to be
// submitted back to front.
#include "blend/sort_types.h"

#include "gpu/radix_sort.h"
#include "method/one_pass_method.h"
#include "util/rounding.h"

namespace oitlab::blend {

/// Sorts a scene's triangles on the device, back to front by the distance of their centroids.
/// Triangles at equal distances stay in the order of submission.
class CentroidSort {
 public:
  /// The scene must have at least one transparent triangle. `sequenced`: sequence() is wanted.
  CentroidSort(const Device& device, MemoryLedger& memory, const GpuScene& scene, bool sequenced)
      : count_(scene.transparentCount()),
        keys_(Pipeline::compute(device, "blend/centroid_keys.comp")),
        gather_(Pipeline::compute(device, "blend/gather_indices.comp")),
        sort_(device, memory, count_),
        indices_(device, memory, "sorted indices", 12ull * count_) {
    if (sequenced)
      sequence_ = Buffer(device, memory, "places of triangles in the order",
                         4ull * scene.scene().triangles.size());
  }

  /// Writes the vertex indices of the sorted triangles to indices(), and for each primitive id its
  /// place in the order to sequence().
  void record(const Frame& frame) const {
    using Stage = vk::PipelineStageFlagBits2;
    const CentroidPush push{.frame = frame.constants,
                            .submitted = frame.scene.transparentIndices().address(),
                            .sorted = indices_.address(),
                            .sequence = sequence_.address(),
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
    frame.barrier(Stage::eComputeShader, Stage::eIndexInput | Stage::eComputeShader);
  }

  const Buffer& indices() const { return indices_; }
  const Buffer& sequence() const { return sequence_; }

 private:
  std::uint32_t count_;  // triangles
  Pipeline keys_, gather_;
  RadixSort sort_;
  Buffer indices_, sequence_;
};

class Blend : public OnePassMethod {
 public:
  explicit Blend(const MethodContext& context)
      : OnePassMethod(context,
                      {.file = "blend/blend.glsl", .access = Access::blended, .needsId = false}) {
    if (context.parameters.choice("order") == "sorted" && context.scene.transparentCount() > 0)
      sort_.emplace(context.device, context.memory, context.scene, !isHardware(context.parameters));
  }

  void record(const Frame& frame) override {
    Submission submission;
    // In every frame, even if the camera does not move, as an application with a moving one would.
    if (sort_) {
      frame.stage("sort", [&] { sort_->record(frame); });
      submission = {.indices = &sort_->indices(), .sequence = &sort_->sequence()};
    }
    recordPass(frame, "blend", FrameOnly{}, submission);
  }

 private:
  std::optional<CentroidSort> sort_;
};

const RegisterMethod registered({
    .name = "blend",
    .summary = "alpha blending: fast, and wrong where triangles overlap out of order",
    .source = "Porter and Duff 1984; fixed-function blending",
    .exact = false,
    .parameters = {choice("order", {"submission", "sorted"},
                          "submission: as the scene lists triangles; sorted: back to front by "
                          "distance of the centroid, sorted on the device in every frame")},
    .takesFragments = true,
    .make = makeMethod<Blend>,
});

}  // namespace oitlab::blend
