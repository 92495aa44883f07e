#include <cmath>

#include "scene/generate/foliage.h"
#include "scene/generate/generators.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;
constexpr std::uint64_t seed = 17;

// A strand winds around the centre on a circle whose plane rotates and whose radius varies.
void addStrand(MeshBuilder& builder, Pcg32 random, int segments, int sides, float radius,
               std::uint32_t material) {
  const glm::vec3 axis = randomDirection(random);
  const Frame plane = frameAround(axis);
  const float reach = std::sqrt(random.uniform(0.05f, 1.0f)), breath = random.uniform(0.05f, 0.3f);
  const float turns = random.uniform(0.9f, 1.5f), tilt = random.uniform(-0.6f, 0.6f);
  const float phase = fullTurn * random.uniform(), wave = random.uniform(1.0f, 4.0f);
  std::vector<glm::vec3> path;
  for (int i = 0; i <= segments; ++i) {
    const float t = float(i) / float(segments);
    const float angle = phase + turns * fullTurn * t;
    const float lift = tilt * std::sin(2.3f * angle);
    const glm::vec3 out =
        std::cos(angle) * plane.right + std::sin(angle) * plane.up + lift * glm::normalize(axis);
    const float r = reach * (1.0f - breath * (0.5f + 0.5f * std::sin(wave * angle)));
    path.push_back(r * glm::normalize(out));
  }
  const glm::vec3 color =
      glm::mix(glm::vec3(0.75f, 0.35f, 0.12f), glm::vec3(0.95f, 0.8f, 0.5f), random.uniform());
  tube(builder, path, sides, std::vector<float>(path.size(), radius), false, {color, material});
}

void hairStructure(MeshBuilder& builder, float fineness) {
  const float s = std::sqrt(fineness);
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  const int strands = scaledCount(3000, s, 1), segments = scaledCount(160, s, 3), sides = 3;
  if (builder.counting()) {
    const auto n = std::uint64_t(strands) * sides;
    return builder.count(n * std::uint64_t(segments + 1), 2 * n * std::uint64_t(segments));
  }
  // If there are fewer strands they are thicker, so that they cover the same area.
  const float radius = 0.00105f * 3000.0f / float(strands);
  for (int i = 0; i < strands; ++i)
    addStrand(builder, Pcg32(seed, std::uint64_t(i)), segments, sides, radius, material);
}

void buildHairball(MeshBuilder& builder, float detail) {
  buildToCount(builder, 2880000.0 * detail, hairStructure);
  builder.view("default", orbitCamera(glm::vec3(0.0f), 2.147f, 0.4f, 0.3f, 0.8726646f));
}

}  // namespace

const GeneratedScene generated::hairball{
    "hairball", "thin tubes wound in a ball, opacity 0.5: deep everywhere; 2,880,000 triangles",
    buildHairball};

}  // namespace oitlab
