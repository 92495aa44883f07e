#pragma once

#include "frame/frame.h"
#include "method/method.h"

namespace oitlab {

/// What one frame gave.
struct FrameResult {
  std::optional<double> frameMs;  ///< GPU time; empty when the timestamps were unusable
  std::vector<std::pair<std::string, double>> stageMs;  ///< instrumented frames only
  double cpuMs = 0;    ///< CPU time to record and submit, waiting excluded
  int recordings = 1;  ///< more than 1: the method grew its memory, and the last one counts
  std::map<std::string, std::uint64_t> counters;
};

/// Makes frames: opaque pass, then the method, one frame in flight. All methods that are compared
/// share one Renderer, and with it scene, target and clock.
class Renderer {
 public:
  /// `scene` and `target` must outlive this.
  Renderer(const Device& device, const GpuScene& scene, const Target& target);

  /// A method for this renderer's scene and target, which must outlive it. Throws as
  /// MethodInfo::makeFor().
  std::unique_ptr<Method> make(const MethodInfo& info, const Parameters& parameters) const;

  /// Renders one frame and waits for it. Records again for as long as the method asks for it.
  /// Throws DeviceError when the device fails or the method does not come to an end.
  FrameResult render(Method& method, const Camera& camera, bool instrumented = false);

  const Device& device() const { return device_; }
  const GpuScene& scene() const { return scene_; }
  const Target& target() const { return target_; }

  /// Device memory of scene, target and `method`, by buffer.
  std::map<std::string, std::uint64_t> memoryByBuffer(const Method& method) const;

 private:
  FrameResult renderOnce(Method& method, const Camera& camera, bool instrumented, Status& status);
  void recordOpaque(const Frame& frame) const;
  void recordBackground(const Frame& frame, std::uint32_t part) const;

  const Device& device_;
  const GpuScene& scene_;
  const Target& target_;
  MemoryLedger memory_;
  FrameBindings bindings_;
  FrameTimer timer_;
  bool depthCleared_ = false;
  Pipeline opaque_, background_;
  Buffer constants_;
  Commands commands_;
  vk::raii::Fence fence_;
};

/// Linear background behind every scene: a light neutral grey, on which both dark and bright layers
/// show.
inline constexpr glm::vec4 backgroundColor{0.6f, 0.6f, 0.6f, 1.0f};

}  // namespace oitlab
