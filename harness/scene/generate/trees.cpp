// Scenes of alpha-textured cards: a few large ones (scrub pine), many that intersect (white oak),
// and a cloud of smoke.
#include <cmath>

#include "scene/generate/foliage.h"
#include "scene/generate/generators.h"

namespace oitlab {
namespace {

// If there are fewer cards they are larger, so that the number of samples is the same.
float sizeAt(float halfSize, float fineness) {
  return halfSize / std::sqrt(std::min(fineness, 1.0f));
}

constexpr glm::vec3 barkColor(0.32f, 0.2f, 0.12f);

void pineStructure(MeshBuilder& builder, float fineness) {
  const std::uint32_t needles = builder.texturedMaterial([] {
    return needleTexture(256, {0.3f, 0.48f, 0.28f}, 7);
  });
  const std::uint32_t bark = builder.blendMaterial(0.5f);
  // A shrub: several crowns on top of each other.
  constexpr int crownCount = 4;
  addTrunk(builder,
           {.height = 2.2f,
            .radius = 0.14f,
            .crown = {0.9f, 0.6f, 0.9f},
            .branches = 1,
            .sides = 3,
            .segments = 3,
            .seed = 3},
           {barkColor, bark});
  for (int i = 0; i < crownCount; ++i) {
    const float up = float(i) / float(crownCount - 1);
    const float angle = 2.4f * float(i);
    addCards(builder,
             {.center = glm::vec3(0.4f * std::cos(angle), 1.0f + 1.5f * up, 0.4f * std::sin(angle)),
              .radii = {1.15f - 0.55f * up, 0.55f, 1.15f - 0.55f * up},
              .hollow = 0.3f,
              .halfSize = sizeAt(0.34f, fineness),
              .quads = scaledCount(42, fineness, 0),
              .pentagons = scaledCount(12.75f, fineness, 1),
              .seed = std::uint64_t(11 + i)},
             {glm::vec3(1.0f), needles});
  }
}

void buildPine(MeshBuilder& builder, float detail) {
  buildToCount(builder, 527.0 * detail, pineStructure);
  builder.view("default", orbitCamera({0, 1.5f, 0}, 6.1f, 0.6f, 0.12f, 0.8726646f));
}

void oakStructure(MeshBuilder& builder, float fineness) {
  const std::uint32_t leaves = builder.texturedMaterial([] {
    return leafClusterTexture(256, 60, 0.24f, {0.36f, 0.55f, 0.2f}, 5);
  });
  const std::uint32_t bark = builder.blendMaterial(0.5f);
  const float s = std::cbrt(fineness);
  const glm::vec3 crown(5.0f, 3.4f, 5.0f);
  addTrunk(builder,
           {.height = 5.0f,
            .radius = 0.55f,
            .crown = crown,
            .branches = scaledCount(30, s, 2),
            .sides = scaledCount(6, s, 3),
            .segments = scaledCount(17, s, 1),
            .seed = 9},
           {barkColor, bark});
  // Boughs: the crown consists of balls with gaps between them.
  constexpr int boughs = 22;
  Pcg32 random(21);
  for (int i = 0; i < boughs; ++i) {
    glm::vec3 out = randomDirection(random);
    out.y = std::abs(out.y) * 0.9f;
    addCards(builder,
             {.center = glm::vec3(0, 5.2f, 0) + crown * out * random.uniform(0.35f, 0.85f),
              .radii = glm::vec3(random.uniform(1.5f, 2.3f)) * glm::vec3(1.0f, 0.7f, 1.0f),
              .halfSize = sizeAt(0.269f, fineness),
              .quads = scaledCount(564, fineness, 1),
              .pentagons = scaledCount(84, fineness, 0),
              .seed = std::uint64_t(100 + i)},
             {glm::vec3(1.0f), leaves});
  }
}

void buildOak(MeshBuilder& builder, float detail) {
  buildToCount(builder, 37000.0 * detail, oakStructure);
  builder.view(
      "default",
      {.eye = {2.2f, 1.8f, 2.2f}, .target = {0.6f, 6.6f, -2.2f}, .fovY = 0.66f, .near = 0.01f});
}

void buildSmoke(MeshBuilder& builder, float detail) {
  const std::uint32_t puff = builder.texturedMaterial([] { return puffTexture(128, 0.5f, 3); });
  const int cards = scaledCount(6734, detail, 8);
  // A plume of puffs that becomes wider as it rises and leans in the wind.
  constexpr int puffCount = 12;
  for (int i = 0; i < puffCount; ++i) {
    const float up = (float(i) + 0.5f) / float(puffCount);
    const float wide = 0.3f + 0.9f * up;
    addCards(builder,
             {.center = {1.2f * up * up, 3.6f * up, 0.35f * std::sin(5.0f * up)},
              .radii = {wide, 0.55f, wide},
              .halfSize = 0.105f + 0.079f * up,
              .quads = cards * (i + 1) / puffCount - cards * i / puffCount,
              .seed = std::uint64_t(31 + i)},
             {glm::vec3(0.95f), puff});
  }
  builder.view("default", orbitCamera({0.4f, 1.9f, 0.0f}, 5.8f, 0.3f, 0.1f, 0.8726646f));
}

}  // namespace

const GeneratedScene generated::scrubpine{
    "scrubpine", "a shrub of few big alpha-textured cards; 527 triangles", buildPine};

const GeneratedScene generated::smoke{
    "smoke", "a plume of soft textured particle cards; 13,468 triangles", buildSmoke};

const GeneratedScene generated::whiteoak{
    "whiteoak", "a tree of alpha-textured leaf cards that cut each other; 37,000 triangles",
    buildOak};

}  // namespace oitlab
