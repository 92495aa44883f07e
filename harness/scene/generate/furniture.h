#pragma once

#include "scene/generate/shapes.h"

namespace oitlab {

// What several rooms of the generated scenes hold. Sizes in metres; `fineness` 1 is said per piece.

/// An office chair with cushions, arms and a star of five legs: about 4,800 triangles at 1.
void addChair(MeshBuilder& builder, const Placement& place, float fineness, const Paint& cushion,
              const Paint& frame);

/// A column from y = 0 to `height` with base, fluted shaft and capital: about 2,900 triangles at 1.
void addColumn(MeshBuilder& builder, glm::vec3 foot, float height, float radius, float fineness,
               const Paint& paint);

/// An arch over the points `from` and `to` (at the same height), half a circle of square section
/// with half sides `thick`: about 200 triangles at 1.
void addArch(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float thick, float fineness,
             const Paint& paint);

/// A vase or pot standing on `foot`: about 1,900 triangles at 1.
void addVase(MeshBuilder& builder, glm::vec3 foot, float height, float fineness,
             const Paint& paint);

/// A balustrade of turned posts and a rail, from one point to the other: 560 triangles a post at 1.
void addBalustrade(MeshBuilder& builder, glm::vec3 from, glm::vec3 to, float height, int posts,
                   float fineness, const Paint& paint);

}  // namespace oitlab
