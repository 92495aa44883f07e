// The library of real scenes, where it is there.
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/scene.h"
#include "support/shared_scenes.h"

namespace oitlab {
namespace {

using nlohmann::json;

TEST(SharedScenes, AllLoadWithTheTrianglesOfTheirManifest) {
  OITLAB_NEEDS_SHARED_SCENES();
  const json manifest = json::parse(std::ifstream(sharedScenes() / "manifest.json"));
  ASSERT_EQ(manifest["scenes"].size(), 24u);
  for (const json& entry : manifest["scenes"]) {
    const auto file = entry["file"].get<std::string>();
    SCOPED_TRACE(file);
    const Scene scene = loadScene({(sharedScenes() / file).string()});
    EXPECT_EQ(scene.triangles.size(), entry["triangles"].get<std::size_t>());
    EXPECT_EQ(scene.textures.size(), entry["textures"].get<std::size_t>());
    EXPECT_EQ(scene.materials.size(), entry["materials"].get<std::size_t>());
    EXPECT_TRUE(scene.repairs.empty());
    for (int i = 0; i < 3; ++i) {
      const float size = scene.bounds.max[i] - scene.bounds.min[i];
      EXPECT_NEAR(scene.bounds.min[i], entry["bboxMin"][std::size_t(i)].get<float>(), 1e-3f * size);
      EXPECT_NEAR(scene.bounds.max[i], entry["bboxMax"][std::size_t(i)].get<float>(), 1e-3f * size);
    }
  }
}

}  // namespace
}  // namespace oitlab
