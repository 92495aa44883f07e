#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace oitlab {

/// The triangles of a scene as quads. Quad (a, b, c, d) is the triangles (a, b, c) and (a, c, d).
/// Each has the winding that it has in the scene, but may start at another corner; code that
/// depends on the order of the corners takes the triangle from Scene::triangles by its id. A
/// degenerate quad is a triangle without a partner: (a, b, c, c), with the corners as in the scene
/// and an empty second half.
struct QuadMesh {
  /// In `triangles`: there is no second triangle.
  static constexpr std::uint32_t noTriangle = ~0u;

  std::vector<glm::uvec4> quads;      ///< indices into Scene::vertices
  std::vector<glm::uvec2> triangles;  ///< the primitive ids of each quad's two halves
  std::uint32_t degenerate = 0;       ///< number of quads of one triangle

  /// The share of all quads, in [0, 100]; 0 when there are no quads.
  double degeneratePercent() const;
};

/// Pairs the scene's triangles. A candidate quad is two triangles that share an edge in opposite
/// directions. The vertices of the edge must be identical: the same index, or all 32 bytes equal,
/// and so of one material. The quads are in the order of their first triangle, the one with the
/// lower id: triangles that are neighbours in the scene stay neighbours.
///
/// The quads are a greedy maximal independent set of the candidates, where two candidates conflict
/// when they share a triangle, and the least degree is taken first (Halldorsson and Radhakrishnan,
/// "Greed is Good: Approximating Independent Sets in Sparse and Bounded-Degree Graphs", STOC 1994).
/// The result is deterministic. Time and memory are linear in triangles and vertices, except for
/// the sorting of the edges of a vertex. Runs on one core.
QuadMesh pairTriangles(const Scene& scene);

/// pairTriangles() with a cache in `folder`, under the hash of triangles and vertices. A file that
/// is damaged or of another version is replaced. A folder that cannot be written to is no error.
QuadMesh cachedQuads(const Scene& scene, const std::filesystem::path& folder);

/// With the program's own cache folder.
QuadMesh cachedQuads(const Scene& scene);

}  // namespace oitlab
