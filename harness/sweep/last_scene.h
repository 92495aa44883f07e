#pragma once

#include "frame/gpu_scene.h"

namespace oitlab {

/// The scene of the cells that are being measured, in host and device memory. The next cells often
/// want the same one, at another size or from another view; two at once may not fit.
class LastScene {
 public:
  /// `device` must outlive this.
  explicit LastScene(const Device& device) : device_(device) {}

  /// The scene of `spec`, loaded unless it is the one of the last call. What an earlier call gave
  /// is gone when the scene is another. Throws as loadScene() and GpuScene do.
  const GpuScene& get(const SceneSpec& spec) {
    if (loaded_ && spec_ == spec) return loaded_->onDevice;
    loaded_.reset();  // give the old one back first
    loaded_ = std::make_unique<Loaded>(device_, spec);
    spec_ = spec;
    return loaded_->onDevice;
  }

 private:
  struct Loaded {
    Loaded(const Device& device, const SceneSpec& spec)
        : scene(loadScene(spec)), onDevice(device, scene) {}
    Scene scene;
    GpuScene onDevice;
  };

  const Device& device_;
  SceneSpec spec_;
  std::unique_ptr<Loaded> loaded_;
};

}  // namespace oitlab
