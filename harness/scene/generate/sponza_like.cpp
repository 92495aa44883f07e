#include <cmath>

#include "scene/generate/furniture.h"
#include "scene/generate/generators.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;
constexpr float totalLength = 26.0f;    // length of the court, along x
constexpr float courtHalfWidth = 5.2f;  // half the width of the court
constexpr float aisle = 4.0f;           // width of the galleries around it
constexpr float storeyHeight = 5.0f;
constexpr int bays = 9;

struct Paints {
  Paint stone, floor, roof, cloth[3], green;
};

// One storey of the gallery on one side: columns, arches, thick walls, doors and vaults.
void addGallery(MeshBuilder& builder, float side, float y, float fineness, const Paints& paints) {
  const float front = side * courtHalfWidth, back = side * (courtHalfWidth + aisle);
  const float bay = totalLength / float(bays);
  const float s = std::sqrt(fineness);
  const float spring = 3.0f;
  for (int i = 0; i <= bays; ++i) {
    const float x = -0.5f * totalLength + bay * float(i);
    addColumn(builder, {x, y, front}, spring, 0.28f, fineness, paints.stone);
    box(builder, {}, {x, y + 2.0f, back - side * 0.1f}, {0.25f, 2.0f, 0.15f}, paints.stone);
    addArch(builder, {x, y + spring, front}, {x, y + spring, back}, 0.18f, fineness, paints.stone);
    if (i == bays) break;
    addArch(builder, {x, y + spring, front}, {x + bay, y + spring, front}, 0.2f, fineness,
            paints.stone);
    // The spandrel above the arch: two surfaces, as far apart as the wall is thick.
    for (const float leaf : {-0.25f, 0.25f})
      sheet(builder, scaledCount(16, s, 2), scaledCount(4, s, 1), false, paints.stone,
            [&](float u, float v) {
              const float arc = 0.5f * bay * std::sin(0.5f * fullTurn * u);
              return glm::vec3(x + bay * u, y + spring + arc + (storeyHeight - spring - arc) * v,
                               front + leaf);
            });
    // A vault over the bay.
    sheet(builder, scaledCount(20, s, 2), scaledCount(20, s, 2), false, paints.stone,
          [&](float u, float v) {
            const float lift =
                std::max(std::sin(0.5f * fullTurn * u), std::sin(0.5f * fullTurn * v));
            return glm::vec3(x + bay * u, y + spring + 1.3f * lift, glm::mix(front, back, v));
          });
    // A curtain between the columns.
    if (y > 0.0f || i % 2 == 0)
      sheet(builder, scaledCount(30, s, 3), scaledCount(24, s, 2), false,
            paints.cloth[(i + (side > 0)) % 3], [&](float u, float v) {
              const float fold = 0.14f * std::sin(7.0f * fullTurn * u) * (0.4f + 0.6f * v);
              return glm::vec3(x + 0.3f + (bay - 0.6f) * u, y + 3.4f - 3.2f * v,
                               front + side * 0.6f + fold);
            });
    // A door frame in the back wall, and the room behind it.
    box(builder, {}, {x + 0.5f * bay, y + 1.3f, back - side * 0.12f}, {0.6f, 1.3f, 0.08f},
        paints.roof);
    box(builder, {}, {x + 0.5f * bay, y + 1.9f, back + side * 2.2f}, {0.46f * bay, 1.8f, 1.9f},
        paints.stone);
    addVase(builder, {x + 0.5f * bay, y, front + side * 1.4f}, 0.9f, fineness, paints.green);
  }
  box(builder, {}, {0, y + 0.5f * storeyHeight, back + side * 0.25f},
      {0.5f * totalLength, 0.5f * storeyHeight, 0.2f}, paints.stone);
  box(builder, {}, {0, y + storeyHeight - 0.1f, 0.5f * (front + back)},
      {0.5f * totalLength, 0.1f, 0.5f * aisle}, paints.floor);
  if (y > 0.0f)
    addBalustrade(builder, {-0.5f * totalLength, y, front}, {0.5f * totalLength, y, front}, 0.9f,
                  scaledCount(80, s, 8), 0.35f * s, paints.stone);
}

void sponzaStructure(MeshBuilder& builder, float fineness) {
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  const auto paint = [&](float r, float g, float b) { return Paint{{r, g, b}, material}; };
  const Paints paints{
      paint(0.72f, 0.62f, 0.48f),
      paint(0.5f, 0.42f, 0.36f),
      paint(0.5f, 0.22f, 0.14f),
      {paint(0.65f, 0.1f, 0.1f), paint(0.12f, 0.35f, 0.18f), paint(0.12f, 0.2f, 0.5f)},
      paint(0.3f, 0.5f, 0.28f)};
  const float half = 0.5f * totalLength, wide = courtHalfWidth + aisle;
  box(builder, {}, {0, -0.1f, 0}, {half + 3.0f, 0.1f, wide + 1.0f}, paints.floor);
  for (const float side : {1.0f, -1.0f}) {
    for (const float y : {0.0f, storeyHeight}) addGallery(builder, side, y, fineness, paints);
    // Double end walls with rows of niches.
    for (const float leaf : {0.0f, 0.6f, 2.6f})
      box(builder, {}, {side * (half + 0.2f + leaf), storeyHeight, 0}, {0.12f, storeyHeight, wide},
          paints.stone);
    for (int i = 0; i < 5; ++i)
      for (const float y : {0.0f, storeyHeight})
        addArch(builder, {side * (half - 0.1f), y + 2.6f, -4.5f + 2.2f * float(i) - 0.9f},
                {side * (half - 0.1f), y + 2.6f, -4.5f + 2.2f * float(i) + 0.9f}, 0.15f, fineness,
                paints.stone);
    box(builder, {0.0f * glm::vec3(1), 0.0f},
        {0, 2.0f * storeyHeight + 0.5f, side * (courtHalfWidth + 0.5f * aisle)},
        {half, 0.12f, 0.55f * aisle}, paints.roof);
  }
  // Hanging flags across the court.
  const float s = std::sqrt(fineness);
  for (int i = 0; i < 6; ++i)
    sheet(builder, scaledCount(24, s, 2), scaledCount(24, s, 2), false, paints.cloth[i % 3],
          [&](float u, float v) {
            const float x = -half + 4.0f + 3.6f * float(i);
            return glm::vec3(x + 0.15f * std::sin(fullTurn * (u + v)), 8.4f - 2.6f * v,
                             -2.2f + 4.4f * u);
          });
}

void buildSponza(MeshBuilder& builder, float detail) {
  buildToCount(builder, 262000.0 * detail, sponzaStructure);
  builder.view(
      "default",
      {.eye = {2.4f, 1.8f, -0.5f}, .target = {9.0f, 3.6f, 1.0f}, .fovY = 0.95993f, .near = 0.01f});
}

}  // namespace

const GeneratedScene generated::sponza_like{
    "sponza_like",
    "an atrium: big walls, columns, arches, curtains, opacity 0.5; 262,000 triangles", buildSponza};

}  // namespace oitlab
