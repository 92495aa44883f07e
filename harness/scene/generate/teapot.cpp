// The Utah teapot: 32 bicubic Bezier patches (Martin Newell, "The Utilization of Procedure Models
// in Digital Image Synthesis", PhD thesis, University of Utah, 1975; the height was reduced by Jim
// Blinn and the bottom was added later). Rim, body, lid and bottom are surfaces of revolution, so
// only their profile curves are stored. Handle and spout are symmetric about y = 0, so only half of
// each is stored. The data are z-up.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/generate/generators.h"
#include "scene/generate/mesh_builder.h"

namespace oitlab {
namespace {

using Patch = std::array<std::array<glm::dvec3, 4>, 4>;  // [v][u], u x v points outwards

constexpr int segments = 16;  // per patch edge at full detail: the 16K triangles of the papers
constexpr float sceneOpacity = 0.5f;

// A quarter of a surface of revolution. The inner control points of the arc are on the tangent, at
// `bulge` times the radius: 0.56 in Newell's data, but 0.5625 at the knob.
struct Profile {
  std::array<glm::dvec2, 4> radiusHeight;
  double bulge = 0.56;
};

// Each goes from the top or the outside inwards, so that the outside is the same side for all.
constexpr Profile profiles[] = {
    {{{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}}},  // rim
    {{{{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}}}},            // body
    {{{{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}}}},
    {{{{0.0, 3.15}, {0.8, 3.15}, {0.0, 2.85}, {0.2, 2.7}}}, 0.5625},  // knob; see revolve()
    {{{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}}},           // lid
    {{{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0.0}, {0.0, 0.0}}}},        // bottom
};

// The halves with y <= 0. Rows go along the handle or spout, columns around it.
constexpr Patch halfPatches[] = {
    // handle, from its upper end
    {{{{{-1.6, 0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0, 2.25}}},
      {{{-2.3, 0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0, 2.25}}},
      {{{-2.7, 0, 2.025}, {-2.7, -0.3, 2.025}, {-3.0, -0.3, 2.25}, {-3.0, 0, 2.25}}},
      {{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3.0, -0.3, 1.8}, {-3.0, 0, 1.8}}}}},
    {{{{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3.0, -0.3, 1.8}, {-3.0, 0, 1.8}}},
      {{{-2.7, 0, 1.575}, {-2.7, -0.3, 1.575}, {-3.0, -0.3, 1.35}, {-3.0, 0, 1.35}}},
      {{{-2.5, 0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0, 0.9375}}},
      {{{-2.0, 0, 0.9}, {-2.0, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0, 0.6}}}}},
    // spout, from the body
    {{{{{1.7, 0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0, 0.6}}},
      {{{2.6, 0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0, 0.825}}},
      {{{2.3, 0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0, 2.025}}},
      {{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}}}},
    {{{{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}},
      {{{2.8, 0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0, 2.49375}}},
      {{{2.9, 0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0, 2.5125}}},
      {{{2.8, 0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0, 2.4}}}}},
};

// Rotates by k quarter turns about z. It is exact, so that neighbours share their edge bit for bit.
glm::dvec3 turn(glm::dvec3 p, int k) {
  for (; k > 0; --k) p = {-p.y, p.x, p.z};
  return p;
}

Patch revolve(const Profile& profile, int quarter) {
  Patch patch;
  for (int row = 0; row < 4; ++row) {
    const double radius = profile.radiusHeight[row].x, height = profile.radiusHeight[row].y;
    // Only the knob has another bulge; where it meets the lid the bulge is 0.56 again.
    const double tangent = radius * (row == 3 ? 0.56 : profile.bulge);
    const glm::dvec3 arc[4] = {{radius, 0, height},
                               {radius, -tangent, height},
                               {tangent, -radius, height},
                               {0, -radius, height}};
    for (int column = 0; column < 4; ++column) patch[row][column] = turn(arc[column], quarter);
  }
  return patch;
}

// The other half: y is negated, and the columns are reversed, so that the outside stays outside.
Patch mirror(const Patch& half) {
  Patch patch;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const glm::dvec3& p = half[row][3 - column];
      patch[row][column] = {p.x, -p.y, p.z};
    }
  return patch;
}

std::vector<Patch> teapotPatches() {
  std::vector<Patch> patches;
  for (const Profile& profile : profiles)
    for (int quarter = 0; quarter < 4; ++quarter) patches.push_back(revolve(profile, quarter));
  for (const Patch& half : halfPatches) {
    patches.push_back(half);
    patches.push_back(mirror(half));
  }
  return patches;
}

struct Weights {
  double value[4];
  double slope[4];
};

// Cubic Bernstein polynomials at i / n. They are symmetric in i and n - i bit for bit, so that both
// neighbours compute the same edge, whichever direction they follow it.
Weights bernstein(double i, double n) {
  const double t = i / n, s = (n - i) / n;
  return {{s * s * s, 3 * (s * s) * t, 3 * (t * t) * s, t * t * t},
          {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t}};
}

glm::dvec3 weigh(const double (&w)[4], const std::array<glm::dvec3, 4>& p) {
  return (w[0] * p[0] + w[3] * p[3]) + (w[1] * p[1] + w[2] * p[2]);
}

glm::dvec3 evaluate(const Patch& patch, const double (&u)[4], const double (&v)[4]) {
  return weigh(v, {weigh(u, patch[0]), weigh(u, patch[1]), weigh(u, patch[2]), weigh(u, patch[3])});
}

glm::dvec3 normalAt(const Patch& patch, double i, double j, double n) {
  const Weights u = bernstein(i, n), v = bernstein(j, n);
  const glm::dvec3 alongU = evaluate(patch, u.slope, v.value);
  const glm::dvec3 alongV = evaluate(patch, u.value, v.slope);
  const glm::dvec3 normal = glm::cross(alongU, alongV);
  // At the tip of the knob and the centre of the bottom a row of control points is a single point,
  // and the tangent along u is zero. The normal of a nearby point is used there.
  if (glm::length(normal) < 1e-9) return normalAt(patch, i, j + (j < 0.5 * n ? 1e-3 : -1e-3), n);
  return glm::normalize(normal);
}

glm::vec3 yUp(glm::dvec3 p) {
  return {float(p.x), float(p.z), float(-p.y)};
}

void tessellate(MeshBuilder& builder, const Patch& patch, int n, std::uint32_t material) {
  std::vector<std::uint32_t> grid;
  std::vector<glm::vec3> positions;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const glm::dvec3 p = evaluate(patch, bernstein(i, n).value, bernstein(j, n).value);
      positions.push_back(yUp(p));
      grid.push_back(builder.vertex(yUp(p), yUp(normalAt(patch, i, j, n)),
                                    glm::vec2(i, j) / float(n), glm::vec3(0.8f, 0.45f, 0.2f),
                                    material));
    }
  const auto triangle = [&](int a, int b, int c) {
    // A row that is a single point (see normalAt) makes a fan; triangles without area are left out.
    if (positions[a] != positions[b] && positions[b] != positions[c] &&
        positions[c] != positions[a])
      builder.triangle(grid[a], grid[b], grid[c]);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      triangle(a, b, c);
      triangle(a, c, d);
    }
}

void buildTeapot(MeshBuilder& builder, float detail) {
  const int n = std::max(1, int(std::lround(segments * std::sqrt(detail))));
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  for (const Patch& patch : teapotPatches()) tessellate(builder, patch, n, material);
  builder.view("default", orbitCamera({0.2f, 1.5f, 0.0f}, 5.8f, 0.61f, 0.33f, 0.8726646f));
}

}  // namespace

const GeneratedScene generated::teapot{
    "teapot", "the Utah teapot from its 32 Bezier patches, opacity 0.5; 16,256 triangles",
    buildTeapot};

}  // namespace oitlab
