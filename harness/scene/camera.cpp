#include "scene/camera.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>

#include "util/error.h"

namespace oitlab {
namespace {

// The near plane as a share of the scene's radius, or of the distance of an orbit. It can be this
// close because reversed float depth has the same relative precision wherever the near plane is. It
// must be this close because in an interior view objects are near the eye. A triangle clipped there
// would be missing from the image of every method, and nobody would notice.
constexpr float nearShare = 0.001f;

constexpr float defaultFov = 60.0f;

constexpr const char* forms =
    "'orbit:YAW,PITCH,DISTANCE[,FOV]' (radians, FOV in degrees) or "
    "'look:EX,EY,EZ,TX,TY,TZ[,FOV]'";

float degreesToRadians(float degrees) {
  return degrees * std::numbers::pi_v<float> / 180.0f;
}

// Parses numbers separated by commas. False when one does not parse or is not finite, or when there
// are too many.
bool parseNumbers(std::string_view text, std::array<float, 7>& numbers, std::size_t& count) {
  for (count = 0; count < numbers.size();) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    float& number = numbers[count];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || !std::isfinite(number)) return false;
    ++count;
    text.remove_prefix(std::size_t(end - text.data()));
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    if (text.empty()) return true;
    if (text.front() != ',') return false;
    text.remove_prefix(1);
  }
  return false;
}

float radiusOf(const Bounds& bounds) {
  const float radius = bounds.radius();
  return radius > 0.0f ? radius : 1.0f;
}

float parseFov(const std::string& text, float degrees) {
  if (!(degrees > 0.0f && degrees < 180.0f))
    fail<InputError>(
        "view '{}': the field of view is {} degrees, expected more than 0 and less than 180", text,
        degrees);
  return degreesToRadians(degrees);
}

}  // namespace

glm::mat4 Camera::viewMatrix() const {
  const glm::vec3 forward = glm::normalize(target - eye);
  glm::vec3 upwards = up;
  // If the camera looks along `up`, its roll is undefined, and another axis defines it.
  if (glm::length(glm::cross(forward, upwards)) < 1e-4f * glm::length(upwards))
    upwards = std::abs(forward.y) > 0.5f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  return glm::lookAtRH(eye, target, upwards);
}

glm::mat4 Camera::projectionMatrix(float aspect) const {
  const float focal = 1.0f / std::tan(0.5f * fovY);
  glm::mat4 projection(0.0f);
  projection[0][0] = focal / aspect;
  projection[1][1] = -focal;  // Vulkan's clip space: y down
  projection[2][3] = -1.0f;   // w = distance
  projection[3][2] = near;    // z = near, so z / w = near / distance
  return projection;
}

DepthRange depthRange(const Camera& camera, const Bounds& bounds) {
  const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
  float nearest = std::numeric_limits<float>::max(), farthest = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point = {corner & 1 ? bounds.max.x : bounds.min.x,
                             corner & 2 ? bounds.max.y : bounds.min.y,
                             corner & 4 ? bounds.max.z : bounds.min.z};
    const float depth = glm::dot(point - camera.eye, forward);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  nearest = std::max(nearest, camera.near);
  return {nearest, std::max(farthest, 1.001f * nearest)};
}

Camera orbitCamera(glm::vec3 center, float distance, float yaw, float pitch, float fovY) {
  const glm::vec3 outwards(std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                           std::cos(pitch) * std::cos(yaw));
  // The derivative of `outwards` with respect to pitch. The image is the same as with +Y, and other
  // than +Y it also works for a camera that looks straight down.
  const glm::vec3 up(-std::sin(pitch) * std::sin(yaw), std::cos(pitch),
                     -std::sin(pitch) * std::cos(yaw));
  return {.eye = center + distance * outwards,
          .target = center,
          .up = up,
          .fovY = fovY,
          .near = nearShare * distance};
}

Camera overviewCamera(const Bounds& bounds) {
  const float radius = radiusOf(bounds);
  return {.eye = bounds.center() + 2.0f * radius * glm::normalize(glm::vec3(0.7f, 0.4f, 1.0f)),
          .target = bounds.center(),
          .fovY = degreesToRadians(50.0f),
          .near = nearShare * radius};
}

Camera parseCamera(const std::string& text, const Bounds& bounds) {
  const std::string_view view = text;
  const bool orbit = view.starts_with("orbit:");
  const bool look = view.starts_with("look:");
  const std::size_t wanted = orbit ? 3 : 6;
  std::array<float, 7> n{};
  std::size_t count = 0;
  if ((!orbit && !look) || !parseNumbers(view.substr(orbit ? 6 : 5), n, count) ||
      (count != wanted && count != wanted + 1))
    fail<InputError>("view '{}': expected {}", text, forms);
  const float fov = parseFov(text, count > wanted ? n[wanted] : defaultFov);

  if (orbit) {
    if (!(n[2] > 0.0f))
      fail<InputError>("view '{}': the distance is {}, expected more than 0", text, n[2]);
    return orbitCamera(bounds.center(), n[2], n[0], n[1], fov);
  }
  const Camera camera{.eye = {n[0], n[1], n[2]},
                      .target = {n[3], n[4], n[5]},
                      .fovY = fov,
                      .near = nearShare * radiusOf(bounds)};
  if (camera.eye == camera.target)
    fail<InputError>("view '{}': eye and target are the same point", text);
  return camera;
}

}  // namespace oitlab
