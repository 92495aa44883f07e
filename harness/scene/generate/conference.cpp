#include <cmath>

#include "scene/generate/furniture.h"
#include "scene/generate/generators.h"
#include "util/random.h"

namespace oitlab {
namespace {

constexpr float sceneOpacity = 0.5f;
constexpr float totalLength = 14.0f, width = 8.0f, height = 3.2f;  // metres

void addRoom(MeshBuilder& builder, std::uint32_t material) {
  const Paint wall{{0.78f, 0.72f, 0.62f}, material}, carpet{{0.3f, 0.28f, 0.36f}, material};
  const Paint wood{{0.5f, 0.32f, 0.18f}, material}, white{{0.9f, 0.9f, 0.88f}, material};
  const float x = 0.5f * totalLength, z = 0.5f * width;
  // Walls are single and face inwards: back-face culling keeps them in a view from inside.
  panel(builder, {-x, 0, z}, {totalLength, 0, 0}, {0, 0, -width}, 1, 1, carpet);
  panel(builder, {-x, height, -z}, {totalLength, 0, 0}, {0, 0, width}, 1, 1, white);
  panel(builder, {-x, 0, -z}, {totalLength, 0, 0}, {0, height, 0}, 1, 1, wall);
  panel(builder, {x, 0, z}, {-totalLength, 0, 0}, {0, height, 0}, 1, 1, wall);
  panel(builder, {-x, 0, z}, {0, 0, -width}, {0, height, 0}, 1, 1, wall);
  panel(builder, {x, 0, -z}, {0, 0, width}, {0, height, 0}, 1, 1, wall);
  for (int i = 0; i < 10; ++i)  // wooden panels along the walls
    for (const float side : {1.0f, -1.0f})
      box(builder, {}, {-x + totalLength * (float(i) + 0.5f) / 10.0f, 0.5f, side * (z - 0.02f)},
          {0.045f * totalLength, 0.4f, 0.015f}, wood);
  for (int i = 0; i < 6; ++i)  // lamps
    for (int j = 0; j < 3; ++j)
      box(builder, {},
          {-x + totalLength * (float(i) + 0.5f) / 6.0f, height - 0.03f, (float(j) - 1.0f) * 2.3f},
          {0.6f, 0.02f, 0.15f}, white);
  box(builder, {}, {x - 0.04f, 1.05f, -2.0f}, {0.03f, 1.05f, 0.5f}, wood);  // door
}

void conferenceStructure(MeshBuilder& builder, float fineness) {
  const std::uint32_t material = builder.blendMaterial(sceneOpacity);
  addRoom(builder, material);
  const Paint cushion{{0.62f, 0.16f, 0.12f}, material}, metal{{0.35f, 0.36f, 0.4f}, material};
  const Paint wood{{0.55f, 0.35f, 0.2f}, material}, slat{{0.85f, 0.84f, 0.78f}, material};
  // Long thin triangles: blinds in front of the windows of one side.
  const int slats = scaledCount(60, std::sqrt(fineness), 6);
  for (int window = 0; window < 5; ++window)
    for (int i = 0; i < slats; ++i)
      box(builder, {},
          {-5.4f + 2.7f * float(window), 1.0f + 1.8f * (float(i) + 0.5f) / float(slats), -3.93f},
          {1.1f, 0.35f * 1.8f / float(slats), 0.01f}, slat);
  // Tables with large flat tops.
  for (const float x : {-2.4f, 2.4f}) {
    box(builder, {}, {x, 0.74f, 0}, {2.3f, 0.03f, 0.75f}, wood);
    for (const float leg : {-1.9f, 1.9f})
      box(builder, {}, {x + leg, 0.36f, 0}, {0.06f, 0.35f, 0.5f}, wood);
  }
  const float seats = std::pow(fineness, 0.3f);
  const float each = fineness / seats;
  const int row = scaledCount(12, seats, 3), wallRow = scaledCount(19, seats, 3);
  Pcg32 random(4);
  const auto chair = [&](float x, float z, float turn) {
    const float jitter = random.uniform(-0.4f, 0.4f);
    addChair(builder, {{x, 0, z}, turn + jitter}, each, cushion, metal);
  };
  const float back = 0.5f * fullTurn;
  for (int i = 0; i < row; ++i)
    for (const bool far : {false, true})
      chair(-4.6f + 9.2f * (float(i) + 0.5f) / float(row), far ? -1.15f : 1.15f, far ? 0.0f : back);
  for (int i = 0; i < wallRow; ++i)
    for (const bool far : {false, true})
      chair(-6.4f + 12.8f * (float(i) + 0.5f) / float(wallRow), far ? -3.2f : 3.2f,
            far ? 0.0f : back);
}

void buildConference(MeshBuilder& builder, float detail) {
  buildToCount(builder, 331000.0 * detail, conferenceStructure);
  builder.view("default", {.eye = {3.4f, 1.9f, 3.4f},
                           .target = {6.6f, 1.1f, -0.6f},
                           .fovY = 0.8726646f,
                           .near = 0.01f});
}

}  // namespace

const GeneratedScene generated::conference{
    "conference", "a room of big flat walls and finely made chairs, opacity 0.5; 331,000 triangles",
    buildConference};

}  // namespace oitlab
