#pragma once

#include "frame/frame.h"
#include "method/method.h"
#include "render/opaque_pass.h"

namespace oitlab {

/// The result of one frame.
struct FrameResult {
  std::optional<double> frameMs;  ///< GPU time; empty when the timestamps were unusable
  std::vector<std::pair<std::string, double>> stageMs;  ///< instrumented frames only
  double cpuMs = 0;    ///< CPU time to record and submit, without waiting
  int recordings = 1;  ///< more than 1: buffers grew; the rest is of the last recording
  std::map<std::string, std::uint64_t> counters;
};

/// Renders frames: the opaque pass, then the method. One frame is in flight at a time. All methods
/// that are compared share one Renderer, and with it scene, target and clock.
class Renderer {
 public:
  /// `scene` and `target` must outlive this.
  Renderer(const Device& device, const GpuScene& scene, const Target& target);

  /// A method for this renderer's scene and target, which must outlive it. Throws what
  /// MethodInfo::makeFor() throws.
  std::unique_ptr<Method> make(const MethodInfo& info, const Parameters& parameters) const;

  /// Renders one frame and waits for it. Records it again as long as the method asks for that.
  /// Throws DeviceError when the device fails, or when the method asks too often.
  FrameResult render(Method& method, const Camera& camera, bool instrumented = false);

  const Device& device() const { return device_; }
  const GpuScene& scene() const { return scene_; }
  const Target& target() const { return target_; }

  /// Device memory of the scene, the target and `method`, by buffer.
  std::map<std::string, std::uint64_t> memoryByBuffer(const Method& method) const;

 private:
  FrameResult renderOnce(Method& method, const Camera& camera, bool instrumented, Status& status);
  const OpaquePass& opaquePassOf(const Method& method);
  void recordBackground(const Frame& frame, std::uint32_t part) const;

  const Device& device_;
  const GpuScene& scene_;
  const Target& target_;
  MemoryLedger memory_;
  FrameTimer timer_;
  bool depthCleared_ = false;
  OpaquePass opaque_;
  std::optional<OpaquePass> opaqueOfCompute_;  // from the first method that needs it
  Pipeline background_;
  Buffer constants_;
  Commands commands_;
  vk::raii::Fence fence_;
};

}  // namespace oitlab
