#pragma once

// Which pixels a triangle covers, and where in the triangle a pixel's centre lies.

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace oitlab::cpu_reference {

// 128 bits hold every product below exactly, so coverage needs no tolerance.
__extension__ typedef __int128 Int128;

/// A vertex in homogeneous pixel space: x / w is 2 * (pixels from the target's centre), so that the
/// centre of pixel i has the integer coordinate 2 * i + 1 - width. In fixed point: rounded once,
/// and from there on all arithmetic of coverage is exact.
struct Position {
  std::int64_t x = 0, y = 0, w = 0;  ///< magnitude at most 2^53
};

/// All vertices of a scene as one camera sees them on a target of width x height pixels, each side
/// at most 2^14.
class Projection {
 public:
  Projection(const Scene& scene, const Camera& camera, int width, int height);

  const Position& operator[](std::uint32_t vertex) const { return positions_[vertex]; }
  double unit() const { return unit_; }  ///< scene units per unit of Position::w
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  std::vector<Position> positions_;
  double unit_ = 1.0;
  int width_, height_;
};

/// Pixels [x0, x1) x [y0, y1).
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// A pixel's centre seen from a triangle. The weights are those of perspective-correct
/// interpolation: they sum to 1, and any attribute is the weighted sum of the corners'.
struct Hit {
  bool covered = false;
  bool nearEdge = false;  ///< an edge passes within Triangle::edgeDoubt pixels, covered or not
  glm::dvec3 weight{0.0};
  glm::dvec3 weightDx{0.0}, weightDy{0.0};  ///< their exact derivatives, per pixel
  double distance = 0.0;                    ///< w: along the view direction, in scene units
};

/// A triangle rasterized in homogeneous coordinates (Olano and Greer, "Triangle Scan Conversion
/// using 2D Homogeneous Coordinates", 1997): nothing is divided by w and nothing is clipped, so
/// vertices beside and behind the eye are vertices like all others.
class Triangle {
 public:
  /// Devices snap vertices to a grid, of 1/256 pixel as a rule (subPixelPrecisionBits = 8): whether
  /// they cover a pixel is open where an edge comes closer than that.
  static constexpr double edgeDoubt = 1.0 / 256;

  Triangle(const Projection& projection, const glm::uvec3& corners);

  /// Pixel (x, y). Neither covered nor nearEdge: the rest is not filled in. What is behind the eye
  /// is neither.
  Hit at(int x, int y) const;

  /// Holds all pixels where something at `nearest` (scene units, > 0) or farther may be hit.
  PixelBox box(double nearest) const;

 private:
  struct Edge {
    Int128 a = 0, b = 0, c = 0;  // a x + b y + c: positive on the left in the sense of the winding
    double reach = 0.0;          // its change over edgeDoubt pixels
  };
  const Projection& projection_;
  Position corners_[3];
  Edge edges_[3];  // edge i is opposite of corner i
};

}  // namespace oitlab::cpu_reference
