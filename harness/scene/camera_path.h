#pragma once

#include <vector>

#include "scene/camera.h"

namespace oitlab {

/// A fly-through: keyframes at equal time steps. Catmull-Rom splines interpolate their eyes and
/// targets, so that the speed is continuous.
class CameraPath {
 public:
  /// At least one keyframe. Up vector, field of view and near plane are interpolated linearly.
  explicit CameraPath(std::vector<Camera> keyframes);

  /// The camera at `t` in [0, 1], from the first keyframe at 0 to the last at 1.
  Camera at(float t) const;

  const std::vector<Camera>& keyframes() const { return keyframes_; }

 private:
  std::vector<Camera> keyframes_;
};

}  // namespace oitlab
