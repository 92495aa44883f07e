#include "scene/scene.h"

#include <cstdlib>
#include <fstream>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/environment.h"
#include "support/glb.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/random.h"

namespace oitlab {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

bool near(glm::vec3 a, glm::vec3 b, float tolerance) {
  return glm::distance(a, b) < tolerance;
}

TEST(Random, IsPcg32AsPublished) {  // the first numbers of the reference implementation's demo
  Pcg32 random(42, 54);
  for (const std::uint32_t wanted :
       {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
    EXPECT_EQ(random.next(), wanted);
}

TEST(Packing, NormalsSurviveTheRoundTrip) {
  Pcg32 random(1);
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::length(v) < 0.1f) continue;
    const glm::vec3 normal = glm::normalize(v);
    const glm::dvec3 back = unpackNormal(packNormal(normal));
    ASSERT_LT(glm::length(glm::cross(back, glm::dvec3(normal))), 1e-4);  // 0.006 degrees
    ASSERT_GT(glm::dot(back, glm::dvec3(normal)), 0.9);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec3 normal(0.0f);
      normal[axis] = sign;
      EXPECT_EQ(unpackNormal(packNormal(normal)), normal);
    }
}

TEST(Packing, ColorsRoundToNearestAndClamp) {
  EXPECT_EQ(packColor({0, 1, 0.5f, 1}), 0xff80ff00u);
  EXPECT_EQ(packColor({-1, 2, std::nanf(""), 0.499f / 255}), 0x0000ff00u);
}

TEST(LoadScene, KnobsOutOfRangeAreRefused) {
  const auto message = [](SceneSpec spec) {
    return messageOf<InputError>([&] { loadScene(spec); });
  };
  EXPECT_THAT(message({"boxes", {}, 0.0f}),
              AllOf(HasSubstr("detail is 0"), HasSubstr("at most 1")));
  EXPECT_THAT(message({"boxes", {}, 1.5f}), HasSubstr("detail is 1.5"));
  EXPECT_THAT(message({"boxes", {}, std::nanf("")}), HasSubstr("detail is nan"));
  EXPECT_THAT(message({"boxes", 0.0f}), HasSubstr("opacity is 0"));
  EXPECT_THAT(message({"boxes", -1.0f}), HasSubstr("opacity is -1"));
}

TEST(LoadScene, UnknownNamesGetASuggestion) {
  EXPECT_THAT(messageOf<InputError>([] { loadScene({"boxs"}); }),
              AllOf(HasSubstr("'boxs'"), HasSubstr("did you mean 'boxes'"), HasSubstr("teapot")));
  EXPECT_THAT(messageOf<InputError>([] { loadScene({"no/such/file.glb"}); }),
              HasSubstr("no/such/file.glb"));
  EXPECT_THAT(messageOf<InputError>([] { loadScene({"."}); }),
              AllOf(HasSubstr("expected a .glb"), HasSubstr(".obj")));
}

TEST(FindView, NamesThenForms) {
  const Scene scene = loadScene({"planes"});
  EXPECT_EQ(findView(scene, "default").eye, scene.views.at("default").eye);
  EXPECT_EQ(findView(scene, "look:1,2,3,0,0,0").eye, glm::vec3(1, 2, 3));
  EXPECT_THAT(
      messageOf<InputError>([&] { findView(scene, "defualt"); }),
      AllOf(HasSubstr("'defualt'"), HasSubstr("did you mean 'default'"), HasSubstr("planes")));
}

TEST(OverrideOpacity, KeepsWhatMasksCutOut) {
  Scene scene;
  scene.materials = {
      {.alphaMode = AlphaMode::opaque, .ignoreTextureAlpha = true},
      {.baseColor = {1, 1, 1, 0.8f}, .alphaMode = AlphaMode::mask, .alphaCutoff = 0.4f},
      {.baseColor = {1, 1, 1, 0.9f}, .alphaMode = AlphaMode::blend},
      {.baseColor = {1, 1, 1, 0}, .alphaMode = AlphaMode::mask, .alphaCutoff = 0.5f}};
  overrideOpacity(scene, 0.2f);
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.alphaMode, AlphaMode::blend);
    EXPECT_EQ(material.baseColor.a, 0.2f);
    EXPECT_TRUE(material.ignoreVertexAlpha);
  }
  EXPECT_EQ(scene.materials[0].alphaCutoff, 0.0f);
  EXPECT_TRUE(scene.materials[0].ignoreTextureAlpha);
  EXPECT_FLOAT_EQ(scene.materials[1].alphaCutoff, 0.1f);  // half the opacity before, half after
  EXPECT_EQ(scene.materials[2].alphaCutoff, 0.0f);
  EXPECT_GT(scene.materials[3].alphaCutoff, 1.0f);  // invisible before and after
}

// Views in TOML files, with the test's own data root.
class NamedViews : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    std::filesystem::create_directories(folder_ / "experiments");
    root_.emplace("OITLAB_ROOT", folder_.string());
    GlbBuilder glb;
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}})}});
    path_ = glb.write(folder_ / "x.glb");
  }
  void TearDown() override {
    root_.reset();  // a bundle's launcher sets it, and the tests after this one need that value
    TemporaryFolder::TearDown();
  }
  void toml(const char* name, const char* text) { std::ofstream(folder_ / name) << text; }

  std::string path_;
  std::optional<ScopedEnvironment> root_;
};

TEST_F(NamedViews, NoFileIsNoError) {
  EXPECT_EQ(loadScene({path_}).views.size(), 1u);
}

TEST_F(NamedViews, TheFileBesideTheSceneHasTheLastWord) {
  toml("experiments/views.toml",
       "[x]\ndefault = 'look:1,0,0,0,0,0'\nside = 'look:2,0,0,0,0,0'\n[y]\nother = 'look:'\n");
  EXPECT_EQ(findView(loadScene({path_}), "default").eye, glm::vec3(1, 0, 0));
  toml("x.toml", "[views]\nside = 'look:3,0,0,0,0,0'\n");
  const Scene scene = loadScene({path_});
  EXPECT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(findView(scene, "default").eye, glm::vec3(1, 0, 0));
  EXPECT_EQ(findView(scene, "side").eye, glm::vec3(3, 0, 0));
}

TEST_F(NamedViews, PathsAreViewsToo) {
  toml("x.toml", "[paths]\nfly = ['look:0,0,5,0,0,0', 'look:4,0,5,4,0,0']\n");
  const Scene scene = loadScene({path_});
  EXPECT_TRUE(near(findView(scene, "path:fly@0.25").eye, {1, 0, 5}, 1e-5f));
  const auto message = [&](const char* view) {
    return messageOf<InputError>([&] { findView(scene, view); });
  };
  EXPECT_THAT(message("path:fli@0.5"), AllOf(HasSubstr("'fli'"), HasSubstr("did you mean 'fly'")));
  EXPECT_THAT(message("path:fly@1.5"), HasSubstr("'1.5'"));
  EXPECT_THAT(message("path:fly@"), HasSubstr("from 0 to 1"));
  EXPECT_THAT(message("path:fly"), HasSubstr("path:NAME@T"));
}

TEST_F(NamedViews, GeneratedScenesHaveTheirOwnTables) {
  toml("experiments/views.toml",
       "[x]\na = 'look:1,0,0,0,0,0'\n[x.paths]\nfly = ['look:1,0,0,0,0,0']\n"
       "[boxes]\nwrong = 'look:1,0,0,0,0,0'\n[generated.boxes]\nb = 'look:2,0,0,0,0,0'\n");
  EXPECT_TRUE(loadScene({path_}).paths.contains("fly"));
  const Scene boxes = loadScene({"boxes"});
  EXPECT_TRUE(boxes.views.contains("b"));
  EXPECT_FALSE(boxes.views.contains("wrong"));
}

TEST_F(NamedViews, ErrorsNameFileAndLine) {
  const auto message = [&](const char* text) {
    toml("x.toml", text);
    return messageOf<InputError>([&] { loadScene({path_}); });
  };
  EXPECT_THAT(message("[views\n"), HasSubstr("x.toml:1:"));
  EXPECT_THAT(message("[views]\n\na = 3\n"), AllOf(HasSubstr("x.toml:3"), HasSubstr("'a'")));
  EXPECT_THAT(message("[views]\na = 'orbit:1'\n"),
              AllOf(HasSubstr("x.toml:2"), HasSubstr("orbit:1")));
  EXPECT_THAT(message("views = 1\n"), HasSubstr("x.toml:1"));
  EXPECT_THAT(message("paths = 1\n"), HasSubstr("x.toml:1"));
  EXPECT_THAT(message("[paths]\nfly = []\n"), AllOf(HasSubstr("x.toml:2"), HasSubstr("'fly'")));
  EXPECT_THAT(message("[paths]\nfly = ['look:1,2,3,4,5,6',\n 3]\n"), HasSubstr("x.toml:3"));
}

TEST_F(NamedViews, ADataRootThatIsNotThereIsAnError) {
  ::setenv("OITLAB_ROOT", (folder_ / "nowhere").c_str(), 1);
  EXPECT_THAT(messageOf<InputError>([&] { loadScene({path_}); }), HasSubstr("OITLAB_ROOT"));
}

}  // namespace
}  // namespace oitlab
