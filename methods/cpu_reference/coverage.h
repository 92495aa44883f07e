#pragma once

// Which pixels a triangle covers, and where in the triangle a pixel's centre is.

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace oitlab::cpu_reference {

// 128 bits represent every product below exactly, so coverage needs no tolerance.
__extension__ typedef __int128 Int128;

/// A vertex in homogeneous pixel space. x / w is twice the number of pixels from the target's
/// centre, so that the centre of pixel i has the integer coordinate 2 * i + 1 - width. It is in
/// fixed point and rounded once; after that all arithmetic of coverage is exact.
struct Position {
  std::int64_t x = 0, y = 0, w = 0;  ///< magnitude at most 2^53
};

/// All vertices of a scene as one camera sees them, on a target of width x height pixels with sides
/// of at most 2^14.
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

/// Where a pixel's centre is in a triangle. The weights are those of perspective-correct
/// interpolation: their sum is 1, and each attribute is the weighted sum of the corners'
/// attributes.
struct Hit {
  bool covered = false;
  bool nearEdge = false;  ///< an edge is within Triangle::edgeDoubt pixels, covered or not
  glm::dvec3 weight{0.0};
  glm::dvec3 weightDx{0.0}, weightDy{0.0};  ///< their exact derivatives, per pixel
  double distance = 0.0;                    ///< w: along the view direction, in scene units
};

/// A triangle that is rasterized in homogeneous coordinates (Olano and Greer, "Triangle Scan
/// Conversion using 2D Homogeneous Coordinates", 1997). There is no division by w and no clipping,
/// so vertices beside and behind the eye need no special treatment.
class Triangle {
 public:
  /// Devices snap vertices to a grid, usually of 1/256 pixel (subPixelPrecisionBits = 8). If an
  /// edge is closer to a centre than that, a device may decide either way.
  static constexpr double edgeDoubt = 1.0 / 256;

  Triangle(const Projection& projection, const glm::uvec3& corners);

  /// The hit of pixel (x, y). If it is neither covered nor nearEdge the rest is not filled in.
  /// Behind the eye it is neither.
  Hit at(int x, int y) const;

  /// A box that contains all pixels with a hit at the distance `nearest` (scene units, > 0) or
  /// more.
  PixelBox box(double nearest) const;

 private:
  struct Edge {
    Int128 a = 0, b = 0, c = 0;  // a x + b y + c, positive to the left of the edge
    double reach = 0.0;          // the change of the function over edgeDoubt pixels
  };
  const Projection& projection_;
  Position corners_[3];
  Edge edges_[3];  // edge i is opposite to corner i
};

}  // namespace oitlab::cpu_reference
