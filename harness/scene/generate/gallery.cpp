#include <cmath>

#include "scene/generate/furniture.h"
#include "scene/generate/generators.h"
#include "util/random.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;
constexpr float totalLength = 30.0f, width = 9.0f, height = 7.0f;

// An abstract statue: a ball that is stretched upwards and dented by waves.
void addStatue(MeshBuilder& builder, glm::vec3 foot, int n, std::uint64_t seed,
               const Paint& paint) {
  Pcg32 random(seed);
  const glm::vec3 wave(random.uniform(2, 6), random.uniform(2, 6), random.uniform(2, 6));
  const glm::vec3 phase(random.uniform(0, 6), random.uniform(0, 6), random.uniform(0, 6));
  const float twist = random.uniform(-2.0f, 2.0f);
  box(builder, {foot}, {0, 0.45f, 0}, {0.4f, 0.45f, 0.4f}, paint);
  ball(builder, n, paint, [&](glm::vec3 d) {
    const glm::vec3 dent = glm::sin(wave * d + phase);
    const float r = 0.36f * (1.0f + 0.35f * dent.x * dent.y + 0.2f * dent.z) +
                    0.006f * std::sin(40.0f * d.y + 3.0f * dent.x);
    const float a = twist * d.y;
    const glm::vec3 turned(d.x * std::cos(a) + d.z * std::sin(a), d.y,
                           d.z * std::cos(a) - d.x * std::sin(a));
    return foot + glm::vec3(0, 1.75f, 0) + r * turned * glm::vec3(1.0f, 2.3f, 1.0f);
  });
}

void galleryStructure(MeshBuilder& builder, float fineness) {
  const float s = std::sqrt(fineness);
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  const Paint floor{{0.45f, 0.38f, 0.33f}, material}, wall{{0.72f, 0.6f, 0.45f}, material};
  const Paint marble{{0.85f, 0.83f, 0.8f}, material}, gold{{0.85f, 0.65f, 0.25f}, material};
  const float z = 0.5f * totalLength, x = 0.5f * width;
  panel(builder, {-x, 0, z}, {width, 0, 0}, {0, 0, -totalLength}, 1, 1, floor);
  panel(builder, {-x, 0, -z}, {width, 0, 0}, {0, height, 0}, 1, 1, wall);
  for (const float side : {1.0f, -1.0f})  // walls with relief
    sheet(builder, scaledCount(330, s, 4), scaledCount(80, s, 2), false, wall,
          [&](float u, float v) {
            const float relief =
                0.05f * std::sin(40.0f * fullTurn * u) * std::sin(6.0f * fullTurn * v);
            return glm::vec3(side * (x - std::abs(relief)), height * v * 0.8f,
                             side * totalLength * (u - 0.5f));
          });
  // A coffered vault.
  sheet(builder, scaledCount(330, s, 4), scaledCount(160, s, 4), false, gold,
        [&](float u, float v) {
          const float a = 0.5f * fullTurn * v;
          const float coffer = std::max(std::sin(30.0f * fullTurn * u), 0.0f) *
                               std::max(std::sin(8.0f * fullTurn * v), 0.0f);
          const float r = 1.0f + 0.03f * std::min(4.0f * coffer, 1.0f);
          return glm::vec3(x * r * std::cos(a), 0.8f * height + 0.35f * x * r * std::sin(a),
                           totalLength * (0.5f - u));
        });
  const int statues = scaledCount(24, std::pow(fineness, 0.2f), 4);
  const int n = scaledCount(50, std::sqrt(24.0f * fineness / float(statues)), 1);
  for (int i = 0; i < statues; ++i) {
    const float side = i % 2 ? 1.0f : -1.0f;
    const float along =
        -z + 2.0f + (totalLength - 5.0f) * (float(i / 2) + 0.5f) / float((statues + 1) / 2);
    addStatue(builder, {side * 2.6f, 0, along}, n, std::uint64_t(50 + i), marble);
  }
  const int columns = 6;
  for (int i = 0; i < columns; ++i)
    for (const float side : {1.0f, -1.0f})
      addColumn(builder, {side * (x - 0.45f), 0, -z + totalLength * (float(i) + 0.5f) / columns},
                5.4f, 0.2f, fineness * 1.7f, marble);
  // Pictures: flat canvases in ornamental frames. Each ornament is a fan of an odd number of
  // triangles, so that pairing leaves one of them over.
  const int ornaments = scaledCount(1150, fineness, 1);
  for (int i = 0; i < 24; ++i) {
    const float side = i % 2 ? 1.0f : -1.0f;
    const glm::vec3 center(side * (x - 0.12f), 2.8f,
                           -z + totalLength * (float(i / 2) + 1.0f) / 13.0f);
    panel(builder, center + glm::vec3(0, -0.8f, side * 0.65f), {0, 0, -side * 1.3f}, {0, 1.6f, 0},
          1, 1, {{0.3f, 0.35f, 0.3f}, material});
    if (builder.counting()) {
      builder.count(5 * std::uint64_t(ornaments), 3 * std::uint64_t(ornaments));
      continue;
    }
    Pcg32 random(std::uint64_t(900 + i));
    for (int k = 0; k < ornaments; ++k) {
      const float a = fullTurn * random.uniform(),
                  m = std::max(std::abs(std::cos(a)), std::abs(std::sin(a)));
      const float in = random.uniform(1.0f, 1.15f) / m;
      const glm::vec3 at = center + glm::vec3(-side * 0.06f * random.uniform(),
                                              0.8f * in * std::sin(a), 0.65f * in * std::cos(a));
      const float size = 0.018f, turn = random.uniform(0.0f, 6.0f);
      fan(builder, 5, {-side, 0, 0}, gold, [&](int c) {
        const float b = turn - side * fullTurn * float(c) / 5.0f;
        return at + size * glm::vec3(0.3f * std::sin(2.0f * b), std::sin(b), std::cos(b));
      });
    }
  }
}

void buildGallery(MeshBuilder& builder, float detail) {
  buildToCount(builder, 999000.0 * detail, galleryStructure);
  builder.view(
      "default",
      {.eye = {0.0f, 4.0f, 14.0f}, .target = {0.0f, 4.6f, 0}, .fovY = 1.134464f, .near = 0.01f});
}

}  // namespace

const GeneratedScene generated::gallery{
    "gallery", "a hall of statues, relief and picture frames, opacity 0.5; 999,000 triangles",
    buildGallery};

}  // namespace oitlab
