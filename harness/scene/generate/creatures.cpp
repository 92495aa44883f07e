// Closed meshes of small triangles, each a pixel or less: substitutes for the scanned models.
#include <cmath>

#include "scene/generate/generators.h"
#include "scene/generate/shapes.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;

// A bump on the unit sphere around `direction`, of this height and `width` radians wide.
float bump(glm::vec3 p, glm::vec3 direction, float height, float width) {
  const float away = std::acos(glm::clamp(glm::dot(p, glm::normalize(direction)), -1.0f, 1.0f));
  return height * std::exp(-away * away / (width * width));
}

// Small waves, as on fur or clay.
float ripple(glm::vec3 p, float frequency) {
  return std::sin(frequency * p.x + 1.3f * std::sin(frequency * p.y)) *
         std::sin(frequency * p.y + 1.1f * std::sin(frequency * p.z)) *
         std::sin(frequency * p.z + 0.9f * std::sin(frequency * p.x));
}

glm::vec3 onBunny(glm::vec3 d) {
  float r = 0.75f;
  r += bump(d, {0.8f, 0.75f, 0.0f}, 0.42f, 0.42f);  // head
  r += bump(d, {0.5f, 0.9f, 0.32f}, 0.75f, 0.11f);  // ears
  r += bump(d, {0.5f, 0.9f, -0.32f}, 0.75f, 0.11f);
  r += bump(d, {-1.0f, -0.1f, 0.0f}, 0.16f, 0.25f);  // tail
  r += bump(d, {0.5f, -0.8f, 0.5f}, 0.2f, 0.25f) + bump(d, {0.5f, -0.8f, -0.5f}, 0.2f, 0.25f);
  r += bump(d, {-0.4f, -0.6f, 0.7f}, 0.2f, 0.4f) + bump(d, {-0.4f, -0.6f, -0.7f}, 0.2f, 0.4f);
  r += 0.008f * ripple(d, 23.0f);
  return d * r * glm::vec3(1.0f, 1.0f, 0.85f);
}

void bunnyStructure(MeshBuilder& builder, float fineness) {
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  ball(builder, scaledCount(110, std::sqrt(fineness), 1), {{0.75f, 0.62f, 0.5f}, material},
       onBunny);
}

void buildBunny(MeshBuilder& builder, float detail) {
  buildToCount(builder, 144000.0 * detail, bunnyStructure);
  builder.view("default", orbitCamera({0.1f, 0.1f, 0}, 3.725f, 0.5f, 0.2f, 0.8726646f));
}

// The spine, from the tip of the tail to the snout.
glm::vec3 spine(float t) {
  const float angle = 2.6f * std::numbers::pi_v<float> * t;
  const float neck = glm::smoothstep(0.7f, 1.0f, t);
  return {-1.5f + 2.7f * t + 0.25f * neck,
          0.42f + 0.22f * std::sin(1.3f * angle) * (1.0f - neck) + 0.75f * neck,
          0.42f * std::sin(angle) * (1.0f - 0.8f * neck)};
}

float girth(float t) {
  const float body =
      0.012f +
      0.25f *
          std::pow(std::max(std::sin(std::numbers::pi_v<float> * std::pow(t, 1.25f)), 0.0f), 1.6f);
  const float head = 0.13f * std::exp(-std::pow((t - 0.93f) / 0.035f, 2.0f));
  return std::max(body * (1.0f - 0.55f * glm::smoothstep(0.65f, 0.9f, t)), 0.015f) + head;
}

// A tube with scales. Each end is closed by shrinking rings and a fan.
template <typename Line, typename Girth>
void scaly(MeshBuilder& builder, int around, int along, float scales, const Paint& paint,
           Line&& line, Girth&& thickness) {
  const auto ring = [&](float u, float t) {
    const Frame frame = frameAround(line(t + 1e-3f) - line(t - 1e-3f));
    const float a = u * fullTurn;
    const float row = t * scales, column = u * 36.0f + (std::fmod(std::floor(row), 2.0f) * 0.5f);
    const float scale = 1.0f + 0.07f * (row - std::floor(row)) *
                                   std::abs(std::sin(std::numbers::pi_v<float> * column));
    return line(t) + thickness(t) * scale * (std::cos(a) * frame.right + std::sin(a) * frame.up);
  };
  sheet(builder, around, along, true, paint, ring);
  for (const float t : {0.0f, 1.0f}) {
    const glm::vec3 out =
        (t > 0.5f ? 1.0f : -1.0f) * glm::normalize(line(t + 1e-3f) - line(t - 1e-3f));
    fan(builder, around, out, paint, [&](int k) {
      const float u = float(k) / float(around);
      return ring(t > 0.5f ? u : std::fmod(1.0f - u, 1.0f), t);
    });
  }
}

void dragonStructure(MeshBuilder& builder, float fineness) {
  const float s = std::sqrt(fineness);
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  const Paint skin{{0.35f, 0.6f, 0.42f}, material}, horn{{0.8f, 0.7f, 0.45f}, material};
  scaly(builder, scaledCount(300, s, 5), scaledCount(1120, s, 12), 130.0f, skin, spine, girth);
  for (const float at : {0.44f, 0.7f})  // legs
    for (const float side : {1.0f, -1.0f}) {
      const glm::vec3 hip = spine(at), foot = {hip.x + 0.18f, 0.0f, hip.z + side * 0.36f};
      const glm::vec3 knee = glm::mix(hip, foot, 0.5f) + glm::vec3(-0.16f, 0.08f, side * 0.16f);
      scaly(
          builder, scaledCount(96, s, 4), scaledCount(200, s, 4), 24.0f, skin,
          [=](float t) {
            return (1 - t) * (1 - t) * hip + 2 * t * (1 - t) * knee + t * t * foot +
                   glm::vec3(0.5f * t * t * t * 0.2f, 0, 0);
          },
          [](float t) {
            return 0.12f * (1.0f - 0.6f * t) + 0.035f * glm::smoothstep(0.85f, 1.0f, t);
          });
    }
  for (int i = 0; i < 40; ++i) {  // spikes along the back
    const float t = 0.06f + 0.86f * float(i) / 39.0f;
    const glm::vec3 root = spine(t);
    const float tall = 0.45f * girth(t) + 0.02f;
    scaly(
        builder, scaledCount(16, s, 3), scaledCount(20, s, 2), 1.0f, horn,
        [=](float v) {
          return root + glm::vec3(-0.4f * tall * v * v, 0.85f * girth(t) + tall * v, 0);
        },
        [=](float v) { return 0.3f * tall * (1.0f - v) + 0.002f; });
  }
  for (const float side : {1.0f, -1.0f})  // horns of the head
    scaly(
        builder, scaledCount(32, s, 3), scaledCount(60, s, 3), 12.0f, horn,
        [=](float v) {
          return spine(0.93f) + glm::vec3(-0.25f * v, 0.12f + 0.22f * v - 0.1f * v * v,
                                          side * (0.07f + 0.12f * v));
        },
        [](float v) { return 0.035f * (1.0f - v) + 0.003f; });
}

void buildDragon(MeshBuilder& builder, float detail) {
  buildToCount(builder, 871000.0 * detail, dragonStructure);
  builder.view("default", orbitCamera({0.0f, 0.6f, 0}, 3.234f, 0.5f, 0.25f, 0.8726646f));
}

}  // namespace

const GeneratedScene generated::bunny{
    "bunny", "a closed bumpy ball with ears, fine triangles, opacity 0.5; 144,000 triangles",
    buildBunny};

const GeneratedScene generated::dragon{
    "dragon", "a scaly closed serpent of triangles below a pixel, opacity 0.5; 871,000 triangles",
    buildDragon};

}  // namespace oitlab
