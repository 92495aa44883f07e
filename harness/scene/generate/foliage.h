#pragma once

#include "scene/generate/shapes.h"
#include "util/random.h"

namespace oitlab {

/// A square texture of `size` texels per side with `leaves` scattered pointed leaves. Alpha is
/// nearly binary, with a soft edge of about a texel.
Texture leafClusterTexture(int size, int leaves, float leafLength, glm::vec3 color,
                           std::uint64_t seed);

/// Twigs with needles, from the centre outwards.
Texture needleTexture(int size, glm::vec3 color, std::uint64_t seed);

/// A soft round puff of smoke: alpha falls unevenly from `opacity` at the centre to 0 at the edge.
Texture puffTexture(int size, float opacity, std::uint64_t seed);

/// Textured cards at random positions in an ellipsoidal shell, for foliage or smoke. Orientations
/// are random, so that neighbours intersect.
struct CardCloud {
  glm::vec3 center{0.0f};
  glm::vec3 radii{1.0f};
  float hollow = 0.0f;    ///< share of the radius that is empty
  float halfSize = 0.1f;  ///< of a card; varies by a third in both directions
  int quads = 0;          ///< cards of two triangles
  int pentagons = 0;      ///< cards of three triangles, so that one of them finds no partner
  std::uint64_t seed = 1;
};
void addCards(MeshBuilder& builder, const CardCloud& cloud, const Paint& paint);

/// A trunk of `height` whose branches reach into an ellipsoid with the radii `crown` around its
/// top.
struct TrunkShape {
  glm::vec3 foot{0.0f};
  float height = 3.0f, radius = 0.3f;
  glm::vec3 crown{1.0f};
  int branches = 8, sides = 5, segments = 4;
  std::uint64_t seed = 1;
};
void addTrunk(MeshBuilder& builder, const TrunkShape& shape, const Paint& paint);

/// A unit vector of a uniformly distributed direction.
glm::vec3 randomDirection(Pcg32& random);

}  // namespace oitlab
