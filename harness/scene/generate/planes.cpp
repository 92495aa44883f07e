#include <algorithm>
#include <cmath>

#include "scene/generate/generators.h"
#include "scene/generate/mesh_builder.h"

namespace oitlab {
namespace {

constexpr int planeCount = 32;
constexpr float gap = 0.1f;
constexpr float aspect = 16.0f / 9.0f;  // that of the frames that they fill
constexpr float first = 0.49f;          // half the height of the nearest
constexpr float growth =
    0.0735f;  // farther planes are larger, so that each number of layers is visible
constexpr float sceneOpacity = 0.25f;

// A saturated colour for a hue in [0, 1), linear.
glm::vec3 hueColor(float hue) {
  const glm::vec3 phase = glm::fract(glm::vec3(hue) + glm::vec3(0.0f, 2.0f / 3.0f, 1.0f / 3.0f));
  return glm::clamp(glm::abs(phase * 6.0f - 3.0f) - 1.0f, 0.0f, 1.0f);
}

void buildPlanes(MeshBuilder& builder, float detail) {
  const int n = std::max(1, int(std::lround(float(planeCount) * detail)));
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  for (int i = 0; i < n; ++i) {
    const float half = first + growth * float(i);
    builder.quad({0.0f, 0.0f, -gap * float(i)}, {aspect * half, 0, 0}, {0, half, 0},
                 hueColor(float(i) / float(n)), material);
  }
  // Not exactly head-on: the depth varies a little within each plane, as in any real view.
  builder.view("default", orbitCamera({0.0f, 0.0f, -0.5f * gap * float(n - 1)}, 5.0f, 0.05f, 0.03f,
                                      0.8726646f));
}

}  // namespace

const GeneratedScene generated::planes{
    "planes", "32 parallel planes of different hue, opacity 0.25: 1 to 32 layers; 64 triangles",
    buildPlanes};

}  // namespace oitlab
