#pragma once

#include <string>

#include <glm/glm.hpp>

namespace oitlab {

struct Bounds {
  glm::vec3 min{0.0f};
  glm::vec3 max{0.0f};
  glm::vec3 center() const { return 0.5f * (min + max); }
  float radius() const { return 0.5f * glm::length(max - min); }
};

/// A pinhole camera. World space is right-handed, +Y up. All lengths in scene units.
struct Camera {
  glm::vec3 eye{0.0f, 0.0f, 1.0f};
  glm::vec3 target{0.0f};
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  float fovY = 1.0471976f;  ///< full vertical field of view, radians, in (0, pi)
  float near = 0.01f;       ///< distance of the near plane, > 0; there is no far plane

  /// World to eye space; the eye looks down -Z.
  glm::mat4 viewMatrix() const;

  /// Eye space to Vulkan clip space: y down, reversed depth with an infinite far plane. The depth
  /// is near / distance: 1 at the near plane and 0 at infinity. Reversed float depth has the same
  /// relative precision over the whole range, which an exact sort needs.
  glm::mat4 projectionMatrix(float aspect) const;
};

/// Distances from the eye along the viewing direction.
struct DepthRange {
  float nearest, farthest;  ///< near plane <= nearest < farthest
};

/// The range of depths of the corners of `bounds`, clipped at the near plane. `farthest` is at
/// least 0.1% larger than `nearest`, so that the length of the range is not 0.
DepthRange depthRange(const Camera& camera, const Bounds& bounds);

/// A camera on a sphere around `center`. `yaw` rotates about +Y; at 0 the camera is at +Z. `pitch`
/// lifts the eye towards +Y. Radians; `distance` > 0.
Camera orbitCamera(glm::vec3 center, float distance, float yaw, float pitch, float fovY);

/// A camera that sees all of `bounds`: in direction (0.7, 0.4, 1) from the centre, at twice the
/// radius of the bounding sphere, with a field of view of 50 degrees.
Camera overviewCamera(const Bounds& bounds);

/// Parses the values of `--view` that are not names:
///   orbit:YAW,PITCH,DISTANCE[,FOV]           about the centre of `bounds`; radians, FOV in degrees
///   look:EX,EY,EZ,TX,TY,TZ[,FOV]             eye and target
/// Throws InputError with the text and the two forms.
Camera parseCamera(const std::string& text, const Bounds& bounds);

}  // namespace oitlab
