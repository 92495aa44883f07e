#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace oitlab {

/// The triangles of a scene as quads. Quad (a, b, c, d) stands for the triangles (a, b, c) and
/// (a, c, d), each with the winding that it has in the scene, though it may begin at another corner
/// (what rests on the corners' order takes them from Scene::triangles by id). A degenerate quad is
/// a triangle that found no partner: (a, b, c, c), corners as in the scene; its second half is
/// empty.
struct QuadMesh {
  /// Of `triangles`: no second triangle.
  static constexpr std::uint32_t noTriangle = ~0u;

  std::vector<glm::uvec4> quads;      ///< indices into Scene::vertices
  std::vector<glm::uvec2> triangles;  ///< the primitive ids of each quad's two halves
  std::uint32_t degenerate = 0;       ///< quads of one triangle

  /// Of all quads, in [0, 100]; 0 when there are none.
  double degeneratePercent() const;
};

/// Pairs the scene's triangles: a candidate quad is two triangles of opposite direction along a
/// shared edge, whose vertices are identical (the same index, or all 32 bytes the same), and so of
/// one material. The quads come in order of their first triangle, the lower id: triangles of a
/// material that lie together in the scene do so in the quads.
///
/// A greedy maximal independent set of the candidates, two of which conflict when they share a
/// triangle: least degree first (Halldorsson and Radhakrishnan, "Greed is Good: Approximating
/// Independent Sets in Sparse and Bounded-Degree Graphs", STOC 1994). Deterministic; time and
/// memory linear in triangles and vertices, but for the sorting of the edges of a vertex. On one
/// core.
QuadMesh pairTriangles(const Scene& scene);

/// pairTriangles(), kept on disk in `folder` under the hash of triangles and vertices. A file that
/// is damaged or of another version is made anew; one that cannot be written is done without.
QuadMesh cachedQuads(const Scene& scene, const std::filesystem::path& folder);

/// With the program's own cache folder.
QuadMesh cachedQuads(const Scene& scene);

}  // namespace oitlab
