#include "support/planted.h"

#include "util/random.h"

namespace oitlab::testing {

std::vector<Scene> disorderlyScenes() {
  std::vector<Scene> scenes = {randomSoup(21, 300)};
  for (const char* name : {"whiteoak", "hairball"}) scenes.push_back(loadScene({name, {}, 0.02f}));
  return scenes;
}

Scene fans() {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < 60; ++i) {
    const float angle = 0.05f * float(i), c = std::cos(angle), s = std::sin(angle);
    triangles.push_back({glm::vec3{-c, -1, -s}, {c, -1, s}, {c, 1, s}});
    triangles.push_back({glm::vec3{-c, -1, -s}, {c, 1, s}, {-c, 1, -s}});
    colors.emplace_back(float(i % 7) / 6, float(i % 5) / 4, float(i % 3) / 2, 0.1f);
    colors.push_back(colors.back());
  }
  Scene scene = triangleScene(triangles, colors, frontCamera());
  scene.name = "fans";
  return scene;
}

Scene layers(int count, float depthSpread, float tilt, float alpha) {
  Pcg32 random(7);
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < count; ++i) {
    const float z = -depthSpread * random.uniform(), t = tilt * random.uniform(-1, 1);
    triangles.push_back({glm::vec3{-9, -9, z - t}, {9, -9, z + t}, {0, 9, z}});
    colors.emplace_back(random.uniform(), random.uniform(), random.uniform(), alpha);
  }
  Scene scene = triangleScene(triangles, colors, frontCamera());
  scene.name = fmt::format("{} layers", count);
  return scene;
}

Scene stack(int count, float alpha) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < count; ++i) {
    const float z = -0.001f * float(i);
    triangles.push_back({glm::vec3{-99, -99, z}, {99, -99, z}, {0, 99, z}});
    colors.emplace_back(float(i % 3) / 2, float(i % 4) / 3, float(i % 5) / 4, alpha);
  }
  return triangleScene(triangles, colors, frontCamera());
}

void makeOpaque(Scene& scene, std::size_t first) {
  const auto material = std::uint32_t(scene.materials.size());
  scene.materials.emplace_back();
  for (std::size_t i = first; i < scene.triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      scene.vertices[scene.triangles[i][corner]].material = material;
}

Scene sheet(int cells, float size) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  auto corner = [&](int x, int y) {
    return glm::vec3(size * (2.0f * float(x) / float(cells) - 1.0f),
                     size * (2.0f * float(y) / float(cells) - 1.0f), 0.0f);
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      triangles.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
      triangles.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
    }
  return triangleScene(triangles, {{0, 0, 0, 0.5f}}, frontCamera());
}

std::uint64_t pixelsOf(const Image& image, float red) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    count += std::abs(image.rgba[i] - red) < 1e-3f;
  return count;
}

std::uint64_t pixelsThatDiffer(const Image& a, const Image& b) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4)
    count += !std::equal(&a.rgba[i], &a.rgba[i] + 4, &b.rgba[i]);
  return count;
}

}  // namespace oitlab::testing
