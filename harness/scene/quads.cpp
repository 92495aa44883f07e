#include "scene/quads.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include <xxhash.h>

#include "util/error.h"

namespace oitlab {
namespace {

// Half-edge 3 t + i goes from corner i of triangle t to its next corner. A candidate quad is a pair
// of opposite half-edges, and each half-edge is part of at most one candidate. Therefore a triangle
// has at most three candidates, a candidate conflicts with at most four others, and the time below
// is linear.
constexpr std::uint32_t none = ~0u;
constexpr std::uint32_t upwards = 1u << 31;  // flag of a half-edge: it goes to the higher vertex
constexpr std::uint32_t maxTriangles = (upwards - 1) / 3;

std::uint32_t triangleOf(std::uint32_t halfEdge) {
  return halfEdge / 3;
}
std::uint32_t nextCorner(std::uint32_t corner) {
  return corner == 2 ? 0 : corner + 1;
}

/// For each vertex the index of the first vertex with the same 32 bytes. With it, files without an
/// index buffer and duplicated vertices still give quads.
std::vector<std::uint32_t> weld(const std::vector<Vertex>& vertices) {
  // A hash table with open addressing, at most two thirds full.
  std::vector<std::uint32_t> table(std::bit_ceil(vertices.size() * 3 / 2 + 1), none);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    std::size_t slot = XXH3_64bits(&vertices[i], sizeof(Vertex)) & (table.size() - 1);
    while (table[slot] != none &&
           std::memcmp(&vertices[table[slot]], &vertices[i], sizeof(Vertex)) != 0)
      slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

class Pairing {
 public:
  explicit Pairing(const Scene& scene) : triangles_(scene.triangles) {
    if (triangles_.size() > maxTriangles)
      fail<InputError>(
          "scene '{}': {} triangles are more than the {} that can be paired into quads", scene.name,
          triangles_.size(), maxTriangles);
    findCandidates(weld(scene.vertices));
    chooseGreedily();
  }

  QuadMesh quads() const {
    QuadMesh mesh;
    mesh.quads.reserve(triangles_.size() / 2 + 1);
    mesh.triangles.reserve(triangles_.size() / 2 + 1);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const glm::uvec3& mine = triangles_[t];
      if (chosen_[t] == none) {
        mesh.quads.emplace_back(mine.x, mine.y, mine.z, mine.z);
        mesh.triangles.emplace_back(t, QuadMesh::noTriangle);
        ++mesh.degenerate;
        continue;
      }
      const std::uint32_t other = opposite_[chosen_[t]], u = triangleOf(other);
      if (u < t) continue;
      // This half-edge goes from c to a, the opposite one from a to c.
      const std::uint32_t c = chosen_[t] % 3, a = nextCorner(c), b = nextCorner(a);
      const std::uint32_t d = nextCorner(nextCorner(other % 3));
      mesh.quads.emplace_back(mine[int(a)], mine[int(b)], mine[int(c)], triangles_[u][int(d)]);
      mesh.triangles.emplace_back(t, u);
    }
    return mesh;
  }

 private:
  /// Fills opposite_. Half-edges are grouped by their lower vertex. Each group is sorted by a key:
  /// the higher vertex, then the direction, then the id.
  void findCandidates(const std::vector<std::uint32_t>& welded) {
    const auto ends = [&](std::uint32_t h) {
      const glm::uvec3& t = triangles_[triangleOf(h)];
      return std::pair(welded[t[int(h % 3)]], welded[t[int(nextCorner(h % 3))]]);
    };
    const auto count = std::uint32_t(3 * triangles_.size());
    std::vector<std::uint32_t> begin(welded.size() + 2);
    for (std::uint32_t h = 0; h < count; ++h) {
      const auto [from, to] = ends(h);
      if (from != to) ++begin[std::min(from, to) + 2];
    }
    for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<std::uint64_t> keys(begin.back());
    for (std::uint32_t h = 0; h < count; ++h) {
      const auto [from, to] = ends(h);
      if (from == to) continue;
      const std::uint32_t low = (from < to ? upwards : 0u) | h;
      keys[begin[std::min(from, to) + 1]++] = (std::uint64_t(std::max(from, to)) << 32) | low;
    }

    opposite_.assign(count, none);
    const auto halfEdge = [](std::uint64_t key) { return std::uint32_t(key) & ~upwards; };
    for (std::size_t v = 0; v < welded.size(); ++v) {
      const auto last = keys.begin() + begin[v + 1];
      std::sort(keys.begin() + begin[v], last);
      for (auto edge = keys.begin() + begin[v]; edge != last;) {
        const std::uint64_t top = *edge >> 32;
        const auto up = std::find_if(
            edge, last, [&](std::uint64_t key) { return key >= ((top << 32) | upwards); });
        const auto end =
            std::find_if(up, last, [&](std::uint64_t key) { return key >> 32 != top; });
        // Pairs the n-th half-edge of one direction with the n-th of the other. A closed surface
        // has one of each. Where many triangles meet, trying all pairs would be quadratic.
        for (auto a = edge, b = up; a != up && b != end; ++a, ++b)
          addCandidate(halfEdge(*a), halfEdge(*b));
        edge = end;
      }
    }
  }

  void addCandidate(std::uint32_t h, std::uint32_t g) {
    const std::uint32_t t = triangleOf(h), u = triangleOf(g);
    if (t == u) return;
    // Two triangles that share more than one edge are still only one candidate.
    for (std::uint32_t i = 3 * t; i < 3 * t + 3; ++i)
      if (opposite_[i] != none && triangleOf(opposite_[i]) == u) return;
    opposite_[h] = g;
    opposite_[g] = h;
  }

  bool isOpen(std::uint32_t h) const {
    const std::uint32_t g = opposite_[h];
    return g != none && chosen_[triangleOf(h)] == none && chosen_[triangleOf(g)] == none;
  }

  /// The number of open candidates that the candidate of half-edge h conflicts with.
  std::uint32_t degree(std::uint32_t h) const {
    return open_[triangleOf(h)] + open_[triangleOf(opposite_[h])] - 2u;
  }

  /// Fills chosen_. A candidate is named by the lower of its half-edges. Degrees only decrease.
  /// Each time one does, the candidate is also put into the bucket of its new degree; its old
  /// entries are skipped when they are found.
  void chooseGreedily() {
    chosen_.assign(triangles_.size(), none);
    open_.assign(triangles_.size(), 0);
    for (std::uint32_t h = 0; h < opposite_.size(); ++h)
      open_[triangleOf(h)] += opposite_[h] != none;
    // In reverse order, because buckets are emptied from their end: low ids come first.
    for (auto h = std::uint32_t(opposite_.size()); h-- > 0;)
      if (opposite_[h] != none && h < opposite_[h]) buckets_[degree(h)].push_back(h);
    for (std::size_t least = 0; least < buckets_.size();) {
      if (buckets_[least].empty()) {
        ++least;
        continue;
      }
      const std::uint32_t h = buckets_[least].back();
      buckets_[least].pop_back();
      if (isOpen(h) && degree(h) == least) {
        choose(h);
        least = 0;
      }
    }
  }

  void choose(std::uint32_t h) {
    const std::uint32_t pair[] = {triangleOf(h), triangleOf(opposite_[h])};
    // The triangles that had a candidate with one of the pair, which is closed now.
    std::array<std::uint32_t, 4> neighbours;
    std::size_t count = 0;
    for (const std::uint32_t t : pair)
      for (std::uint32_t i = 3 * t; i < 3 * t + 3; ++i)
        if (isOpen(i) && triangleOf(opposite_[i]) != pair[0] && triangleOf(opposite_[i]) != pair[1])
          neighbours[count++] = triangleOf(opposite_[i]);
    chosen_[pair[0]] = h;
    chosen_[pair[1]] = opposite_[h];
    for (std::size_t n = 0; n < count; ++n) --open_[neighbours[n]];
    for (std::size_t n = 0; n < count; ++n)
      for (std::uint32_t i = 3 * neighbours[n]; i < 3 * neighbours[n] + 3; ++i)
        if (isOpen(i)) {
          const std::uint32_t candidate = std::min(i, opposite_[i]);
          buckets_[degree(candidate)].push_back(candidate);
        }
  }

  const std::vector<glm::uvec3>& triangles_;
  std::vector<std::uint32_t>
      opposite_;                       // per half-edge: the opposite one of its candidate, or none
  std::vector<std::uint32_t> chosen_;  // per triangle: its half-edge in the chosen quad, or none
  std::vector<std::uint8_t> open_;     // per triangle: its candidates with free triangles
  std::array<std::vector<std::uint32_t>, 5> buckets_;  // candidates by degree
};

}  // namespace

double QuadMesh::degeneratePercent() const {
  return quads.empty() ? 0.0 : 100.0 * double(degenerate) / double(quads.size());
}

QuadMesh pairTriangles(const Scene& scene) {
  return Pairing(scene).quads();
}

}  // namespace oitlab
