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

  /// Eye space to Vulkan clip space (y down, reversed depth with an infinite far plane): ndc depth
  /// is near / distance, 1 at the near plane and 0 at infinity. Reversed float depth keeps its
  /// relative precision over the whole range, which is what an exact sort needs.
  glm::mat4 projectionMatrix(float aspect) const;
};

/// Distances from the eye along the viewing direction.
struct DepthRange {
  float nearest, farthest;  ///< near plane <= nearest < farthest
};

/// The depths at which something in `bounds` can be seen: those of its corners, cut at the near
/// plane. `farthest` is at least a thousandth beyond `nearest`, so that the range can be divided
/// by.
DepthRange depthRange(const Camera& camera, const Bounds& bounds);

/// A camera on a sphere around `center`: yaw turns about +Y (0 looks from +Z), pitch lifts the eye
/// towards +Y. Radians; `distance` > 0.
Camera orbitCamera(glm::vec3 center, float distance, float yaw, float pitch, float fovY);

/// A camera that sees the whole of `bounds`: from direction (0.7, 0.4, 1) at twice the radius of
/// the bounding sphere, 50 degrees of field of view.
Camera overviewCamera(const Bounds& bounds);

/// Parses what `--view` takes besides names:
///   orbit:YAW,PITCH,DISTANCE[,FOV]           about the centre of `bounds`; radians, FOV in degrees
///   look:EX,EY,EZ,TX,TY,TZ[,FOV]             eye and target
/// Throws InputError naming what was found and the two forms.
Camera parseCamera(const std::string& text, const Bounds& bounds);

}  // namespace oitlab
