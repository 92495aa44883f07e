#pragma once

#include "scene/generate/shapes.h"
#include "util/random.h"

namespace oitlab {

/// A square texture of `size` texels: `leaves` pointed leaves scattered over it, alpha nearly
/// binary with a soft edge of about a texel.
Texture leafClusterTexture(int size, int leaves, float leafLength, glm::vec3 color,
                           std::uint64_t seed);

/// Twigs with needles, from the middle outwards.
Texture needleTexture(int size, glm::vec3 color, std::uint64_t seed);

/// A soft round puff: alpha falls from `opacity` in the middle to 0 at the edge, unevenly.
Texture puffTexture(int size, float opacity, std::uint64_t seed);

/// Textured cards at random within an ellipsoidal shell, as foliage or smoke: any orientation, so
/// that neighbours cut each other.
struct CardCloud {
  glm::vec3 center{0.0f};
  glm::vec3 radii{1.0f};
  float hollow = 0.0f;    ///< share of the radius that is left empty
  float halfSize = 0.1f;  ///< of a card, before a variation of a third either way
  int quads = 0;          ///< cards of two triangles
  int pentagons = 0;      ///< cards of three, cut at a corner: no pairing leaves no single
  std::uint64_t seed = 1;
};
void addCards(MeshBuilder& builder, const CardCloud& cloud, const Paint& paint);

/// A trunk of `height` that forks into branches which reach into an ellipsoid of `crown` radii
/// around its top.
struct TrunkShape {
  glm::vec3 foot{0.0f};
  float height = 3.0f, radius = 0.3f;
  glm::vec3 crown{1.0f};
  int branches = 8, sides = 5, segments = 4;
  std::uint64_t seed = 1;
};
void addTrunk(MeshBuilder& builder, const TrunkShape& shape, const Paint& paint);

/// A unit vector, all directions alike.
glm::vec3 randomDirection(Pcg32& random);

}  // namespace oitlab
