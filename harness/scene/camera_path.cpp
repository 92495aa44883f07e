#include "scene/camera_path.h"

#include <algorithm>
#include <cmath>

#include "util/check.h"

namespace oitlab {
namespace {

glm::vec3 catmullRom(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, float t) {
  return 0.5f * (2.0f * b + t * ((c - a) + t * ((2.0f * a - 5.0f * b + 4.0f * c - d) +
                                                t * (3.0f * (b - c) + d - a))));
}

}  // namespace

CameraPath::CameraPath(std::vector<Camera> keyframes) : keyframes_(std::move(keyframes)) {
  OITLAB_CHECK(!keyframes_.empty());
}

Camera CameraPath::at(float t) const {
  const int last = int(keyframes_.size()) - 1;
  if (last == 0) return keyframes_.front();
  const float along = std::clamp(t, 0.0f, 1.0f) * float(last);
  const int i = std::min(int(along), last - 1);
  const float s = along - float(i);
  // At the ends the path is extended by its last step, so that the camera does not slow down there.
  const auto eye = [&](int k) {
    if (k < 0) return 2.0f * keyframes_[0].eye - keyframes_[1].eye;
    if (k > last)
      return 2.0f * keyframes_[std::size_t(last)].eye - keyframes_[std::size_t(last - 1)].eye;
    return keyframes_[std::size_t(k)].eye;
  };
  const auto target = [&](int k) {
    if (k < 0) return 2.0f * keyframes_[0].target - keyframes_[1].target;
    if (k > last)
      return 2.0f * keyframes_[std::size_t(last)].target - keyframes_[std::size_t(last - 1)].target;
    return keyframes_[std::size_t(k)].target;
  };
  const Camera &from = keyframes_[std::size_t(i)], &to = keyframes_[std::size_t(i + 1)];
  Camera camera;
  camera.eye = catmullRom(eye(i - 1), eye(i), eye(i + 1), eye(i + 2), s);
  camera.target = catmullRom(target(i - 1), target(i), target(i + 1), target(i + 2), s);
  camera.up = glm::mix(from.up, to.up, s);
  camera.fovY = from.fovY + s * (to.fovY - from.fovY);
  camera.near = from.near + s * (to.near - from.near);
  return camera;
}

}  // namespace oitlab
