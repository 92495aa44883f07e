// Hardware alpha blending: what everything else is measured against. Exact only where triangles
// happen to arrive back to front.
#include <glm/glm.hpp>

#include <numeric>

#include "method/method.h"
#include "render/sample_counter.h"

namespace oitlab::blend {

class Blend : public Method {
 public:
  void prepare(const Device& device, const GpuScene& scene, const Target& target,
               const Parameters& parameters) override {
    sorted_ = parameters.choice("order") == "sorted";
    pipeline_ = Pipeline::graphics(device, {.fragmentShader = "blend/blend.frag",
                                            .colorFormats = {vulkanFormat(target.format())},
                                            .depthFormat = Target::depthFormat,
                                            .blends = {straightOver()}});
    if (sorted_)
      indices_ =
          Buffer(device, memory_, "sorted indices",
                 std::max<std::uint64_t>(12ull * scene.transparentCount(), 16), BufferKind::upload);
    samples_.emplace(device);
  }

  void record(const Frame& frame) override {
    // On the CPU, and only when the camera moved: its time is in no GPU figure.
    if (sorted_ && (!sortedFor_ || *sortedFor_ != frame.camera.eye)) {
      sortBackToFront(frame.scene, frame.camera.eye);
      sortedFor_ = frame.camera.eye;
    }
    samples_->reset(frame);
    frame.stage("blend", [&] {
      frame.renderOnTarget([&] {
        samples_->count(frame, [&] {
          pipeline_.bind(frame.commands, frame.bindings);
          pipeline_.push(frame.commands, frame.constants);
          if (sorted_) {
            frame.commands.bindIndexBuffer(indices_.vk(), 0, vk::IndexType::eUint32);
            frame.commands.drawIndexed(frame.scene.transparentCount() * 3, 1, 0, 0, 0);
          } else {
            frame.drawTransparent();
          }
        });
      });
    });
  }

  Status status() override { return {.counters = samples_->counters()}; }

 private:
  void sortBackToFront(const GpuScene& gpuScene, glm::vec3 eye) {
    const Scene& scene = gpuScene.scene();
    const std::vector<std::uint32_t>& ids = gpuScene.submission();
    std::vector<std::pair<float, std::uint32_t>> order;  // squared distance, primitive id
    order.reserve(ids.size());
    for (const std::uint32_t id : ids) {
      const glm::uvec3 t = scene.triangles[id];
      const glm::vec3 centroid = (scene.vertices[t.x].position + scene.vertices[t.y].position +
                                  scene.vertices[t.z].position) /
                                 3.0f;
      const glm::vec3 offset = centroid - eye;
      order.emplace_back(glm::dot(offset, offset), id);
    }
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second > b.second;
    });
    auto out = indices_.mapped<std::uint32_t>();
    std::size_t i = 0;
    for (const auto& [distance, id] : order) {
      const glm::uvec3 t = scene.triangles[id];
      out[i++] = t.x;
      out[i++] = t.y;
      out[i++] = t.z;
    }
  }

  bool sorted_ = false;
  Pipeline pipeline_;
  Buffer indices_;
  std::optional<glm::vec3> sortedFor_;
  std::optional<SampleCounter> samples_;
};

const RegisterMethod registered({
    .name = "blend",
    .summary = "hardware alpha blending: fast, and wrong where triangles overlap out of order",
    .source = "Porter and Duff 1984; fixed-function blending",
    .exact = false,
    .parameters = {choice("order", {"submission", "sorted"},
                          "submission: as the scene lists triangles; sorted: back to front by "
                          "distance of the centroid")},
    .make = [] { return std::make_unique<Blend>(); },
});

}  // namespace oitlab::blend
