// Compares `reference` with the CPU renderer, and tests the CPU renderer as a method.
#include <gmock/gmock.h>

#include "support/shared_scenes.h"
#include "support/truth.h"

namespace oitlab::testing {
namespace {

const Candidate reference{.method = "reference", .hardware = true};

class CpuReferenceAgainstDevice : public GpuTest {};

TEST_F(CpuReferenceAgainstDevice, GeneratedScenes) {
  for (const char* name : {"boxes", "planes", "teapot"})
    expectTruth(reference, loadScene({name, {}, 0.1f}), 160, 90);
}

TEST_F(CpuReferenceAgainstDevice, AllGeneratedScenesAtLowDetail) {
  for (const SceneInfo& info : sceneCatalogue())
    expectTruth(reference, loadScene({info.name, {}, 0.02f}), 128, 72);
}

TEST_F(CpuReferenceAgainstDevice, RandomSoupsWithDuplicates) {
  for (const std::uint64_t seed : {1, 2, 3, 4})
    expectTruth(reference, randomSoup(seed, 200), 96, 96);
}

// If everything is black glass of one opacity, the remaining background shows how many layers are
// in front of it.
TEST_F(CpuReferenceAgainstDevice, FragmentsOfEachPixelAreAsMany) {
  constexpr double opacity = 0.05;
  for (const char* name : {"boxes", "teapot", "soup"}) {
    Scene scene = name == std::string("soup") ? randomSoup(9, 200) : loadScene({name, {}, 0.1f});
    overrideOpacity(scene, float(opacity));
    for (Material& material : scene.materials) material.baseColor = {0, 0, 0, float(opacity)};
    const Camera camera = findView(scene, "default");
    const CpuImage truth = renderOnCpu(scene, camera, 128, 96);
    RenderFixture fixture(scene, 128, 96);
    const Image image = fixture.render("reference", {}, camera).image;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 128; ++x) {
        const double left = double(image.at(x, y)[0]) / double(backgroundColor.r);
        const auto layers = std::lround(std::log(left) / std::log(1.0 - opacity));
        const std::size_t pixel = truth.index(x, y);
        if ((truth.doubts[pixel] & doubt::edge) == 0) {
          ASSERT_EQ(layers, long(truth.fragments[pixel])) << name << " at " << x << ", " << y;
        }
      }
  }
}

TEST_F(CpuReferenceAgainstDevice, ViewsFromInside) {
  expectTruthFromInside(reference);
}

TEST_F(CpuReferenceAgainstDevice, TexturedScenes) {
  OITLAB_NEEDS_SHARED_SCENES();
  for (const char* name : {"oaktree.glb", "flight_helmet.glb", "alpha_blend_mode_test.glb"}) {
    const auto path = sharedScenes() / name;
    if (std::filesystem::exists(path))
      expectTruth(reference, loadScene({path.string(), {}, 1.0f}), 160, 120);
  }
}

// The method gives the result of renderOnCpu(), in every format.
TEST_F(CpuReferenceAgainstDevice, TheMethodUploadsTheSamePicture) {
  const Scene scene = loadScene({"boxes", {}, 0.02f});
  const CpuImage truth = renderOnCpu(scene, findView(scene, "default"), 65, 33);
  const Image wanted = truth.toImage();
  for (const auto& [format, step] : {std::pair(TargetFormat::rgba32f, 0.0),
                                     {TargetFormat::rgba16f, 0x1p-11},
                                     {TargetFormat::rgba8, 0.5 / 255}}) {
    RenderFixture fixture(scene, 65, 33, {}, format);
    const auto result = fixture.render("cpu_reference");
    for (std::size_t i = 0; i < wanted.rgba.size(); ++i)
      ASSERT_NEAR(result.image.rgba[i], wanted.rgba[i], step + 1e-6) << formatName(format);
    EXPECT_EQ(result.frame.counters.at("fragments"), truth.fragmentCount());
    EXPECT_EQ(result.frame.counters.at("edge_pixels"), truth.pixelsInDoubt(doubt::edge));
  }
}

TEST_F(CpuReferenceAgainstDevice, TheMethodFollowsTheCamera) {
  const Scene scene = loadScene({"boxes", {}, 0.02f});
  RenderFixture fixture(scene, 33, 33);
  const MethodInfo info = findMethod("cpu_reference");
  const auto method = fixture.renderer().make(info, Parameters(info.parameters, {}, info.name));
  Camera camera = findView(scene, "default");
  const auto first = fixture.renderer().render(*method, camera).counters;
  EXPECT_EQ(fixture.renderer().render(*method, camera).counters, first) << "cpu_ms too: kept";
  camera.target = camera.eye + (camera.eye - camera.target);
  EXPECT_EQ(fixture.renderer().render(*method, camera).counters.at("fragments"), 0u);
}

}  // namespace
}  // namespace oitlab::testing
