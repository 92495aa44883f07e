#include "scene/scene.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/glb.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/random.h"

namespace oitlab {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

glm::vec3 corner(const Scene& scene, const glm::uvec3& triangle, int i) {
  return scene.vertices[triangle[i]].position;
}

glm::vec3 areaVector(const Scene& scene, const glm::uvec3& t) {
  return 0.5f * glm::cross(corner(scene, t, 1) - corner(scene, t, 0),
                           corner(scene, t, 2) - corner(scene, t, 0));
}

double signedVolume(const Scene& scene) {
  double volume = 0;
  for (const glm::uvec3& t : scene.triangles)
    volume += glm::dot(glm::dvec3(corner(scene, t, 0)), glm::dvec3(areaVector(scene, t))) / 3;
  return volume;
}

// Directed edges, by position, that no neighbour runs through the other way.
std::size_t openEdges(const Scene& scene) {
  using Point = std::tuple<float, float, float>;
  std::map<std::pair<Point, Point>, int> edges;
  const auto point = [](glm::vec3 p) { return Point{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; };
  for (const glm::uvec3& t : scene.triangles)
    for (int i = 0; i < 3; ++i) {
      const Point a = point(corner(scene, t, i)), b = point(corner(scene, t, (i + 1) % 3));
      if (const auto other = edges.find({b, a}); other != edges.end()) {
        if (--other->second == 0) edges.erase(other);
      } else {
        ++edges[{a, b}];
      }
    }
  return edges.size();
}

void expectNormalsMatchFaces(const Scene& scene) {
  for (const glm::uvec3& t : scene.triangles)
    for (int i = 0; i < 3; ++i)
      ASSERT_GT(
          glm::dot(unpackNormal(scene.vertices[t[i]].normal), glm::normalize(areaVector(scene, t))),
          0.3f);
}

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

TEST(Generated, TheCatalogueListsEachOnceAndAllAreWellFormed) {
  std::set<std::string> names;
  for (const SceneInfo& info : sceneCatalogue()) {
    SCOPED_TRACE(info.name);
    EXPECT_TRUE(names.insert(info.name).second);
    EXPECT_FALSE(info.summary.empty());
    const Scene scene = loadScene({info.name, {}, 0.1f});
    EXPECT_EQ(scene.name, info.name);
    EXPECT_TRUE(scene.repairs.empty());
    EXPECT_TRUE(scene.views.contains("default"));
    EXPECT_FALSE(scene.triangles.empty());
    for (const glm::uvec3& t : scene.triangles)
      for (int i = 0; i < 3; ++i) {
        ASSERT_LT(t[i], scene.vertices.size());
        const std::uint32_t material = scene.vertices[t[i]].material;
        ASSERT_LT(material, scene.materials.size());
        ASSERT_EQ(material, scene.vertices[t.x].material);
      }
  }
}

TEST(Generated, BoxesAreClosedAndWhereTheyShouldBe) {
  const Scene scene = loadScene({"boxes"});
  EXPECT_EQ(scene.triangles.size(), 12000u);
  expectNormalsMatchFaces(scene);
  EXPECT_NEAR(signedVolume(scene), 1000 * 0.125, 1e-3);
  EXPECT_EQ(openEdges(scene), 0u);
  const float reach = 0.6f * 4.5f + 0.25f + 0.1f;
  EXPECT_GT(scene.bounds.max.x, reach - 0.1f);
  EXPECT_LE(scene.bounds.max.x, reach);
  EXPECT_GE(scene.bounds.min.y, -reach);
  EXPECT_EQ(loadScene({"boxes"}).vertices[1234].position, scene.vertices[1234].position);
  EXPECT_FLOAT_EQ(glm::length(scene.views.at("default").eye), 10.0f);
}

TEST(Generated, DetailScalesTriangles) {
  EXPECT_EQ(loadScene({"boxes", {}, 0.125f}).triangles.size(), 1500u);
  EXPECT_EQ(loadScene({"boxes", {}, 1e-6f}).triangles.size(), 12u);
  EXPECT_EQ(loadScene({"planes", {}, 0.5f}).triangles.size(), 32u);
  EXPECT_NEAR(double(loadScene({"teapot", {}, 0.25f}).triangles.size()), 16256 / 4, 100);
}

TEST(Generated, PlanesGrowAndFaceTheCamera) {
  const Scene scene = loadScene({"planes"});
  ASSERT_EQ(scene.triangles.size(), 64u);
  const glm::vec3 towards = scene.views.at("default").eye - scene.bounds.center();
  for (const glm::uvec3& t : scene.triangles)
    EXPECT_GT(glm::dot(areaVector(scene, t), towards), 0.0f);
  EXPECT_LT(scene.vertices[4].position.z, scene.vertices[0].position.z);
  EXPECT_GT(scene.vertices[5].position.x, scene.vertices[1].position.x);
}

TEST(Generated, TheTeapotHoldsWater) {
  const Scene scene = loadScene({"teapot"});
  EXPECT_EQ(scene.triangles.size(), 32u * 16 * 16 * 2 - 8 * 16);  // less two fans of four patches
  EXPECT_TRUE(near(scene.bounds.min, {-3, 0, -2}, 1e-3f));
  EXPECT_TRUE(near(scene.bounds.max, {3.434f, 3.15f, 2}, 1e-3f));
  expectNormalsMatchFaces(scene);
  // Open only where the real one is: inside of the rim, edge of the lid (four patches each), both
  // ends of handle and spout (two patches each).
  EXPECT_EQ(openEdges(scene), 16u * (4 + 4 + 2 * 2 + 2 * 2));
  EXPECT_GT(signedVolume(scene), 0.0);
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
  EXPECT_THAT(messageOf<InputError>([] { loadScene({"."}); }), HasSubstr("expected a .glb"));
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
  EXPECT_GT(scene.materials[3].alphaCutoff, 1.0f);  // never seen before, nor after
}

// Views in TOML files, with a data root of the test's own.
class NamedViews : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    std::filesystem::create_directories(folder_ / "experiments");
    ::setenv("OITLAB_ROOT", folder_.c_str(), 1);
    GlbBuilder glb;
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}})}});
    path_ = glb.write(folder_ / "x.glb");
  }
  void TearDown() override {
    ::unsetenv("OITLAB_ROOT");
    TemporaryFolder::TearDown();
  }
  void toml(const char* name, const char* text) { std::ofstream(folder_ / name) << text; }

  std::string path_;
};

TEST_F(NamedViews, NoFileIsNoError) {
  EXPECT_EQ(loadScene({path_}).views.size(), 1u);
}

TEST_F(NamedViews, TheFileBesideTheSceneHasTheLastWord) {
  toml("experiments/scenes.toml",
       "[x]\ndefault = 'look:1,0,0,0,0,0'\nside = 'look:2,0,0,0,0,0'\n[y]\nother = 'look:'\n");
  EXPECT_EQ(findView(loadScene({path_}), "default").eye, glm::vec3(1, 0, 0));
  toml("x.toml", "[views]\nside = 'look:3,0,0,0,0,0'\n");
  const Scene scene = loadScene({path_});
  EXPECT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(findView(scene, "default").eye, glm::vec3(1, 0, 0));
  EXPECT_EQ(findView(scene, "side").eye, glm::vec3(3, 0, 0));
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
}

TEST_F(NamedViews, ADataRootThatIsNotThereIsAnError) {
  ::setenv("OITLAB_ROOT", (folder_ / "nowhere").c_str(), 1);
  EXPECT_THAT(messageOf<InputError>([&] { loadScene({path_}); }), HasSubstr("OITLAB_ROOT"));
}

}  // namespace
}  // namespace oitlab
