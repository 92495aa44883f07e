#include <algorithm>
#include <cmath>

#include "scene/generate/generators.h"
#include "scene/generate/mesh_builder.h"
#include "util/random.h"

namespace oitlab {
namespace {

constexpr int boxesPerAxis = 10;
constexpr float side = 0.5f;
constexpr float spacing = 0.6f;
constexpr float jitter = 0.1f;  // neighbours touch, and no two faces are coplanar
constexpr float sceneOpacity = 0.5f;
constexpr std::uint64_t seed = 1;

void addBox(MeshBuilder& builder, glm::vec3 center, glm::vec3 color, std::uint32_t material) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 out(0.0f), right(0.0f), up(0.0f);
    out[axis] = right[(axis + 1) % 3] = up[(axis + 2) % 3] = 0.5f * side;
    builder.quad(center + out, right, up, color, material);
    builder.quad(center - out, up, right, color, material);
  }
}

void buildBoxes(MeshBuilder& builder, float detail) {
  const int n = std::max(1, int(std::lround(float(boxesPerAxis) * std::cbrt(detail))));
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  Pcg32 random(seed);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const glm::vec3 cell(x, y, z);
        glm::vec3 center = (cell - 0.5f * float(n - 1)) * spacing;
        for (int axis = 0; axis < 3; ++axis) center[axis] += random.uniform(-jitter, jitter);
        const glm::vec3 color = 0.05f + 0.9f * (cell + 0.5f) / float(n);
        addBox(builder, center, color, material);
      }
  builder.view("default", orbitCamera(glm::vec3(0.0f), 10.0f, 0.5f, 0.8f, 1.0471976f));
}

}  // namespace

const GeneratedScene generated::boxes{
    "boxes", "10x10x10 jittered boxes, opacity 0.5: even, deep layering; 12,000 triangles",
    buildBoxes};

}  // namespace oitlab
