#include <cmath>

#include "scene/generate/generators.h"
#include "scene/generate/shapes.h"
#include "util/random.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;
constexpr float totalLength = 60.0f, width = 36.0f, storeyHeight = 5.0f;
constexpr int storeys = 7;

struct Shop {
  MeshBuilder& builder;
  float fineness;
  std::uint32_t material;

  Paint paint(float r, float g, float b) const { return {{r, g, b}, material}; }
};

// A pipe along the axes, with round bends and flanges at the bends.
void addRun(const Shop& shop, Pcg32 random, int sides, int steps) {
  constexpr int legs = 5;
  if (shop.builder.counting()) {
    const auto rings = std::uint64_t(legs * steps + 1), around = std::uint64_t(sides);
    shop.builder.count(rings * around, 2 * (rings - 1) * around);
    return shop.builder.count((legs - 1) * 4 * around, (legs - 1) * 4 * around);
  }
  const float radius = 0.03f + 0.17f * std::pow(random.uniform(), 3.0f);
  glm::vec3 at(random.uniform(-0.5f, 0.5f) * totalLength,
               random.uniform(0.02f, 0.98f) * storeyHeight * storeys,
               random.uniform(-0.5f, 0.5f) * width);
  const glm::vec3 size(0.5f * totalLength, storeyHeight * storeys, 0.5f * width);
  std::vector<glm::vec3> corners{at};
  int axis = int(random.next() % 3);
  for (int leg = 0; leg < legs; ++leg) {
    float length = random.uniform(1.5f, axis == 1 ? 6.0f : 14.0f);
    if (random.next() % 2) length = -length;
    const float low = axis == 1 ? 0.2f : -size[axis];
    if (at[axis] + length > size[axis] || at[axis] + length < low) length = -length;
    at[axis] += length;
    corners.push_back(at);
    axis = (axis + 1 + int(random.next() % 2)) % 3;
  }
  std::vector<glm::vec3> path{corners.front()};
  const Paint paint = shop.paint(random.uniform(0.35f, 0.8f), random.uniform(0.4f, 0.6f),
                                 random.uniform(0.35f, 0.7f));
  for (int leg = 0; leg < legs; ++leg) {
    const glm::vec3 a = corners[std::size_t(leg)], b = corners[std::size_t(leg + 1)];
    const glm::vec3 along = glm::normalize(b - a);
    const glm::vec3 from = leg == 0 ? a : a + 3.0f * radius * along;
    const glm::vec3 to = leg == legs - 1 ? b : b - 3.0f * radius * along;
    for (int i = 1; i <= steps; ++i) path.push_back(glm::mix(from, to, float(i) / float(steps)));
    if (leg == legs - 1) break;
    for (const float off : {0.0f, 0.25f}) {
      const glm::vec3 centre = to - off * radius * along;
      pipe(shop.builder, centre - 0.06f * radius * along, centre + 0.06f * radius * along,
           1.6f * radius, sides, 1, false, paint);
    }
  }
  tube(shop.builder, path, sides, std::vector<float>(path.size(), radius), false, paint);
}

// Three vessels, one inside the other.
void addVessel(const Shop& shop, glm::vec3 foot, float radius, float height) {
  const float s = std::sqrt(shop.fineness);
  for (const float shell : {1.0f, 0.85f, 0.5f})
    lathe(shop.builder, {foot}, scaledCount(72, s, 5), scaledCount(60, s, 3),
          shop.paint(0.6f, 0.62f, 0.68f), [&](float v) {
            const float cap =
                std::sqrt(std::max(1.0f - std::pow(std::abs(2.0f * v - 1.0f), 8.0f), 0.0f));
            return glm::vec2(shell * radius * std::max(cap, 0.05f),
                             height * (0.5f + shell * (v - 0.5f)));
          });
}

// Columns, beams and floor gratings of the steel frame, with railings at the edges.
void addFrame(const Shop& shop) {
  const float s = std::sqrt(shop.fineness);
  const Paint steel = shop.paint(0.62f, 0.3f, 0.2f), deck = shop.paint(0.5f, 0.5f, 0.46f);
  constexpr int columnsX = 12, columnsZ = 8;
  const auto x = [](int i) { return (float(i) / columnsX - 0.5f) * totalLength; };
  const auto z = [](int j) { return (float(j) / columnsZ - 0.5f) * width; };
  const float top = storeyHeight * storeys;
  for (int i = 0; i <= columnsX; ++i)
    for (int j = 0; j <= columnsZ; ++j)
      box(shop.builder, {}, {x(i), 0.5f * top, z(j)}, {0.15f, 0.5f * top, 0.15f}, steel);
  for (int k = 1; k <= storeys; ++k) {
    const float y = storeyHeight * float(k);
    for (int j = 0; j <= columnsZ; ++j)
      box(shop.builder, {}, {0, y, z(j)}, {0.5f * totalLength, 0.15f, 0.1f}, steel);
    for (int i = 0; i <= columnsX; ++i)
      box(shop.builder, {}, {x(i), y, 0}, {0.1f, 0.15f, 0.5f * width}, steel);
    // Floors have openings: only some fields have a grating.
    Pcg32 random(std::uint64_t(70 + k));
    for (int i = 0; i < columnsX; ++i)
      for (int j = 0; j < columnsZ; ++j)
        if (random.next() % 10 < 3)
          box(shop.builder, {}, {0.5f * (x(i) + x(i + 1)), y + 0.2f, 0.5f * (z(j) + z(j + 1))},
              {0.5f * totalLength / columnsX, 0.03f, 0.5f * width / columnsZ}, deck);
    for (const float side : {1.0f, -1.0f})
      for (int rail = 1; rail <= 3; ++rail)
        pipe(shop.builder, {-0.5f * totalLength, y + 0.35f * float(rail), side * 0.5f * width},
             {0.5f * totalLength, y + 0.35f * float(rail), side * 0.5f * width}, 0.03f,
             scaledCount(8, s, 3), scaledCount(240, s, 1), false, steel);
  }
}

void plantStructure(MeshBuilder& builder, float fineness) {
  const Shop shop{builder, fineness, builder.blendMaterial(sceneOpacity)};
  const float s = std::sqrt(fineness);
  panel(builder, {-70, 0, 70}, {140, 0, 0}, {0, 0, -140}, 1, 1, shop.paint(0.4f, 0.4f, 0.38f));
  addFrame(shop);
  // The boilers: boxes with walls of upright pipes, one inside the other.
  for (const float x : {-16.0f, 14.0f})
    for (int shell = 0; shell < 3; ++shell) {
      const float half = 7.0f - 1.8f * float(shell);
      const int row = scaledCount(110, std::sqrt(s), 6);
      for (int side = 0; side < 4; ++side)
        for (int i = 0; i < row; ++i) {
          const Placement place{{x, 0, 0}, 0.25f * fullTurn * float(side)};
          const float u = half * (2.0f * (float(i) + 0.5f) / float(row) - 1.0f);
          pipe(builder, place({u, 3.0f, half}), place({u, 31.0f, half}), 0.8f * half / float(row),
               scaledCount(8, std::sqrt(s), 3), scaledCount(60, s, 2), false,
               shop.paint(0.7f, 0.45f, 0.25f));
        }
    }
  for (int i = 0; i < 24; ++i) {
    const float x = (float(i % 8) / 7.0f - 0.5f) * 0.9f * totalLength;
    const float z = (i / 8 == 0 ? -0.38f : i / 8 == 1 ? 0.0f : 0.38f) * width;
    addVessel(shop, {x, 0.3f + storeyHeight * float(i % 3), z}, 1.0f + 0.25f * float(i % 4), 5.5f);
  }
  for (const float z : {-26.0f, 26.0f})  // chimneys, lined
    for (const float lining : {1.0f, 0.8f, 0.6f})
      lathe(builder, {{-38.0f, 0, z}}, scaledCount(90, s, 6), scaledCount(220, s, 4),
            shop.paint(0.72f, 0.6f, 0.55f),
            [&](float v) { return glm::vec2(lining * (4.0f - 1.6f * v), 75.0f * v); });
  const int runs = scaledCount(7200, s, 8);
  const int sides = scaledCount(10, std::pow(fineness, 0.2f), 3),
            steps = scaledCount(12, std::pow(fineness, 0.3f), 1);
  for (int i = 0; i < runs; ++i) addRun(shop, Pcg32(23, std::uint64_t(i)), sides, steps);
}

void buildPlant(MeshBuilder& builder, float detail) {
  buildToCount(builder, 12759000.0 * detail, plantStructure);
  builder.view(
      "default",
      {.eye = {74.0f, 27.5f, 65.0f}, .target = {0, 15.0f, 0}, .fovY = 0.8726646f, .near = 0.05f});
}

}  // namespace

const GeneratedScene generated::powerplant{
    "powerplant",
    "nested boilers, vessels and thousands of pipes, opacity 0.5; 12,759,000 triangles",
    buildPlant};

}  // namespace oitlab
