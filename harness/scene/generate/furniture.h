#pragma once

#include "scene/generate/shapes.h"

namespace oitlab {

// Furniture of the generated scenes. Sizes are in metres. The triangle counts are those at
// `fineness` 1.

/// An office chair with cushions, arms and a star of five legs: about 4,800 triangles.
void addChair(MeshBuilder& builder, const Placement& place, float fineness, const Paint& cushion,
              const Paint& frame);

/// A column from y = 0 to `height` with base, fluted shaft and capital: about 2,900 triangles.
void addColumn(MeshBuilder& builder, glm::vec3 foot, float height, float radius, float fineness,
               const Paint& paint);

/// An arch between the points `from` and `to`, which have the same height: half a circle with a
/// square cross-section of half side `thick`; about 200 triangles.
void addArch(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float thick, float fineness,
             const Paint& paint);

/// A vase or pot standing on `foot`: about 1,900 triangles.
void addVase(MeshBuilder& builder, glm::vec3 foot, float height, float fineness,
             const Paint& paint);

/// A balustrade of turned posts and a rail between two points: 560 triangles per post.
void addBalustrade(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float height, int posts,
                   float fineness, const Paint& paint);

}  // namespace oitlab
