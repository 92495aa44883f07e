#include <cmath>

#include "scene/generate/foliage.h"
#include "scene/generate/furniture.h"
#include "scene/generate/generators.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;
constexpr float halfSide = 11.0f;  // half the side of the court
constexpr float aisle = 4.0f;
constexpr float storeyHeight = 4.2f;

struct Paints {
  Paint wall, stone, tile, wood, bark, leaf, bush, flower;
};

void addTree(MeshBuilder& builder, glm::vec3 foot, float tall, float fineness, std::uint64_t seed,
             const Paint& bark, const Paint& leaf) {
  const float s = std::sqrt(fineness);
  const glm::vec3 crown(0.5f * tall, 0.33f * tall, 0.5f * tall);
  addTrunk(builder,
           {.foot = foot,
            .height = 0.6f * tall,
            .radius = 0.03f * tall,
            .crown = crown,
            .branches = scaledCount(120, s, 4),
            .sides = scaledCount(9, s, 3),
            .segments = scaledCount(16, s, 2),
            .seed = seed},
           bark);
  constexpr int boughs = 14;
  Pcg32 random(seed + 1);
  for (int i = 0; i < boughs; ++i) {
    glm::vec3 out = randomDirection(random);
    out.y *= 0.8f;
    addCards(
        builder,
        {.center = foot + glm::vec3(0, 0.68f * tall, 0) + crown * out * random.uniform(0.3f, 0.8f),
         .radii = tall * glm::vec3(0.19f, 0.12f, 0.19f),
         .halfSize = 0.0205f / std::sqrt(std::min(fineness, 1.0f)),
         .quads = scaledCount(11000, fineness, 1),
         .pentagons = scaledCount(7300, fineness, 1),
         .seed = seed + 100 + std::uint64_t(i)},
        leaf);
  }
}

// One side of the court: along +x at z = halfSide, before it is rotated.
void addSide(MeshBuilder& builder, float turn, float fineness, const Paints& paints) {
  const Placement place{glm::vec3(0.0f), turn};
  const float s = std::sqrt(fineness);
  constexpr int arches = 7;
  const float bay = 2.0f * halfSide / arches;
  for (const float y : {0.0f, storeyHeight}) {
    for (int i = 0; i < arches; ++i) {
      const float x = -halfSide + bay * float(i);
      addColumn(builder, place({x, y, halfSide}), 2.6f, 0.2f, 3.0f * fineness, paints.stone);
      addArch(builder, place({x, y + 2.6f, halfSide}), place({x + bay, y + 2.6f, halfSide}), 0.16f,
              4.0f * fineness, paints.stone);
      const auto post = [&](float u, float z) { return place({x + u * bay, y, z}); };
      if (y > 0.0f)
        addBalustrade(builder, post(0.06f, halfSide), post(0.94f, halfSide), 0.85f,
                      scaledCount(14, std::sqrt(s), 4), 0.9f * fineness, paints.stone);
      addVase(builder, post(0.5f, halfSide - 0.6f), 0.7f, 3.0f * fineness, paints.tile);
      addCards(builder,
               {.center = post(0.5f, halfSide - 0.6f) + glm::vec3(0, 0.95f, 0),
                .radii = glm::vec3(0.45f, 0.4f, 0.45f),
                .halfSize = 0.02f / std::sqrt(std::min(fineness, 1.0f)),
                .quads = scaledCount(3200, fineness, 1),
                .pentagons = scaledCount(3500, fineness, 1),
                .seed = std::uint64_t(700 + i) + std::uint64_t(turn * 97.0f + y)},
               i % 2 ? paints.bush : paints.flower);
      box(builder, place, {x + 0.5f * bay, y + 1.2f, halfSide + aisle - 0.1f}, {0.5f, 1.1f, 0.06f},
          paints.wood);
    }
    box(builder, place, {0, y + 0.5f * storeyHeight, halfSide + aisle + 0.2f},
        {halfSide + aisle, 0.5f * storeyHeight, 0.2f}, paints.wall);
    box(builder, place, {0, y + storeyHeight - 0.12f, halfSide + 0.5f * aisle},
        {halfSide + 0.5f * aisle, 0.12f, 0.5f * aisle}, paints.wood);
  }
  // Roof tiles: rows of half pipes.
  const int rows = scaledCount(90, s, 6);
  for (int i = 0; i < rows; ++i) {
    const float x = -halfSide + 2.0f * halfSide * (float(i) + 0.5f) / float(rows),
                r = 0.9f * halfSide / float(rows);
    sheet(builder, scaledCount(8, s, 2), scaledCount(48, s, 1), false, paints.tile,
          [&](float u, float v) {
            const float a = 0.5f * fullTurn * u;
            const float step = std::floor(v * 12.0f) * 0.02f;
            return place({x + r * std::cos(a),
                          2.0f * storeyHeight + 0.1f + 1.2f * v + r * std::sin(a) + step,
                          halfSide - 0.5f + (aisle + 0.6f) * v});
          });
  }
}

void courtStructure(MeshBuilder& builder, float fineness) {
  const std::uint32_t plain = builder.blendMaterial(sceneOpacity);
  const std::uint32_t leaves = builder.texturedMaterial([] {
    return leafClusterTexture(256, 3, 0.8f, {0.34f, 0.52f, 0.2f}, 8);
  });
  const std::uint32_t petals = builder.texturedMaterial([] {
    return leafClusterTexture(128, 4, 0.7f, {0.8f, 0.3f, 0.35f}, 9);
  });
  const Paint white{glm::vec3(1.0f), leaves};
  const Paints paints{{{0.78f, 0.6f, 0.36f}, plain}, {{0.66f, 0.6f, 0.52f}, plain},
                      {{0.6f, 0.27f, 0.16f}, plain}, {{0.36f, 0.24f, 0.15f}, plain},
                      {{0.34f, 0.26f, 0.2f}, plain}, white,
                      {{0.8f, 1.0f, 0.7f}, leaves},  {glm::vec3(1.0f), petals}};
  const float s = std::sqrt(fineness);
  for (int i = 0; i < 4; ++i) addSide(builder, 0.25f * fullTurn * float(i), fineness, paints);
  panel(builder, {-halfSide - aisle, -0.05f, halfSide + aisle}, {2 * (halfSide + aisle), 0, 0},
        {0, 0, -2 * (halfSide + aisle)}, 1, 1, paints.wall);
  // Paving stones, each slightly domed.
  const int stones = scaledCount(44, std::sqrt(s), 6), cells = scaledCount(10, std::sqrt(s), 1);
  for (int i = 0; i < stones; ++i)
    for (int j = 0; j < stones; ++j) {
      const float size = 2.0f * halfSide / float(stones);
      const glm::vec3 corner(-halfSide + size * float(i), 0, -halfSide + size * float(j + 1));
      sheet(builder, cells, cells, false, paints.stone, [&](float u, float v) {
        const float edge = std::min(std::min(u, 1 - u), std::min(v, 1 - v));
        return corner + glm::vec3(size * u, std::min(edge, 0.1f) * 0.3f, -size * v);
      });
    }
  // Fountain.
  for (const float r : {2.2f, 1.9f, 0.9f})
    lathe(builder, {}, scaledCount(160, s, 6), scaledCount(60, s, 2), paints.stone, [&](float v) {
      return glm::vec2(r * (1.0f - 0.25f * std::sin(0.5f * fullTurn * v) + 0.1f * v),
                       (r < 1.0f ? 1.9f : 0.7f) * v);
    });
  const glm::vec2 trees[] = {{-5.5f, -4.5f}, {5.8f, -5.2f}, {-6.0f, 5.0f}, {5.2f, 5.6f}};
  for (int i = 0; i < 4; ++i)
    addTree(builder, {trees[i].x, 0, trees[i].y}, 6.8f + 0.5f * float(i), fineness,
            std::uint64_t(300 + 40 * i), paints.bark, paints.leaf);
  // Tables with chairs.
  const int sets = scaledCount(14, std::sqrt(s), 4);
  for (int i = 0; i < sets; ++i) {
    const float a = fullTurn * (float(i) + 0.5f) / float(sets);
    const glm::vec3 at(7.6f * std::cos(a), 0, 7.6f * std::sin(a));
    lathe(builder, {at}, scaledCount(48, s, 5), scaledCount(20, s, 2), paints.wood, [](float v) {
      return glm::vec2(v < 0.9f ? 0.06f + 0.15f * std::exp(-9.0f * v) : 0.6f,
                       0.75f * std::min(v / 0.9f, 1.0f));
    });
    for (int c = 0; c < 4; ++c) {
      const float b = fullTurn * float(c) / 4.0f + a;
      addChair(builder, {at + 0.85f * glm::vec3(std::sin(b), 0, std::cos(b)), b + 0.5f * fullTurn},
               2.0f * fineness, paints.wall, paints.wood);
    }
  }
}

void buildCourt(MeshBuilder& builder, float detail) {
  buildToCount(builder, 5617000.0 * detail, courtStructure);
  builder.view(
      "default",
      {.eye = {-3.5f, 1.8f, 0.5f}, .target = {9.0f, 2.6f, 2.0f}, .fovY = 1.0f, .near = 0.01f});
}

}  // namespace

const GeneratedScene generated::sanmiguel{
    "sanmiguel", "a courtyard with arcades and trees of single leaves; 5,617,000 triangles",
    buildCourt};

}  // namespace oitlab
