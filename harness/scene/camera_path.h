#pragma once

#include <vector>

#include "scene/camera.h"

namespace oitlab {

/// A fly-through: cameras at equal steps of time, joined by Catmull-Rom splines through their eyes
/// and targets, so that the speed changes without a jerk.
class CameraPath {
 public:
  /// At least one keyframe. Up, field of view and near plane go over linearly.
  explicit CameraPath(std::vector<Camera> keyframes);

  /// The camera at `t` in [0, 1]: at 0 the first keyframe, at 1 the last.
  Camera at(float t) const;

  const std::vector<Camera>& keyframes() const { return keyframes_; }

 private:
  std::vector<Camera> keyframes_;
};

}  // namespace oitlab
