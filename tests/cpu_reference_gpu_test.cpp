// The CPU renderer as the judge of `reference`, and as a method.
#include <gmock/gmock.h>

#include "cpu_reference/cpu_renderer.h"
#include "support/gpu.h"
#include "support/shared_scenes.h"

namespace oitlab::testing {
namespace {

glm::dvec4 colorAt(const CpuImage& image, int x, int y) {
  return image.color[image.index(x, y)];
}

struct Verdict {
  std::uint64_t wrong = 0;   // pixels in no doubt that differ by more than the tolerance
  std::uint64_t edges = 0;   // pixels that do, in doubt about edges or a cutoff
  std::uint64_t orders = 0;  // pixels that do, in doubt about the order too
  double worst = 0.0;        // difference of a pixel in no doubt
};

Verdict judge(const Image& image, const CpuImage& truth, double tolerance) {
  Verdict verdict;
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x) {
      double difference = 0.0;
      for (int c = 0; c < 3; ++c)
        difference =
            std::max(difference, std::abs(double(image.at(x, y)[c]) - colorAt(truth, x, y)[c]));
      const std::uint8_t doubts = truth.doubts[truth.index(x, y)];
      if (doubts == 0) verdict.worst = std::max(verdict.worst, difference);
      if (!(difference <= tolerance))
        ++(doubts == 0                  ? verdict.wrong
           : doubts & doubt::depthOrder ? verdict.orders
                                        : verdict.edges);
    }
  return verdict;
}

// Of a pixel in no doubt. Measured on llvmpipe: 0.001/255 where there is no texture.
constexpr double tolerance = 2.0 / 255;

// Where textures are sampled, the filter is the device's: llvmpipe truncates the colours between
// the end points of BC blocks, a step of 8-bit sRGB (2.2/255 linear near white; measured: 2.2/255),
// and GPUs weigh texels in steps of 1/256. Vulkan allows both. The level of detail is ours
// (shade.glsl).
constexpr double textureTolerance = 4.0 / 255;

class CpuReferenceAgainstDevice : public GpuTest {
 protected:
  void expectReferenceAgrees(const Scene& scene, const Camera& camera, int width, int height,
                             double allowed = tolerance) {
    SCOPED_TRACE(scene.name);
    const CpuImage truth = renderOnCpu(scene, camera, width, height);
    RenderFixture fixture(scene, std::uint32_t(width), std::uint32_t(height));
    const auto exact = fixture.render("reference", {}, camera);
    const Verdict verdict = judge(exact.image, truth, allowed);
    const double pixels = double(width) * height;
    // Every layer brings its own edges near a sample, so the shares are of pixels where there are
    // few layers, and of fragments where (hair, pipes) there are many.
    const double chances = std::max(pixels, double(truth.fragmentCount()));
    RecordProperty(
        scene.name,
        fmt::format("worst {:.4f}/255; in doubt: edge {}, order {}, cutoff {}", verdict.worst * 255,
                    truth.pixelsInDoubt(doubt::edge), truth.pixelsInDoubt(doubt::depthOrder),
                    truth.pixelsInDoubt(doubt::cutoff)));
    EXPECT_EQ(verdict.wrong, 0u) << "worst: " << verdict.worst * 255 << "/255";
    EXPECT_LT(double(verdict.edges), 0.001 * chances);
    // The oak's leaves are cards with a back of the same vertices in another order: it is open
    // which of the two a device has in front.
    EXPECT_LT(double(verdict.orders), 0.01 * pixels);
    // Doubts are the exception, or nothing was tested.
    EXPECT_LT(double(truth.pixelsInDoubt(0xff)), 0.1 * chances);
    EXPECT_NEAR(double(exact.frame.counters.at("fragments")), double(truth.fragmentCount()),
                double(truth.pixelsInDoubt(doubt::edge | doubt::cutoff)));
  }
  void expectReferenceAgrees(const Scene& scene, int width, int height,
                             double allowed = tolerance) {
    expectReferenceAgrees(scene, findView(scene, "default"), width, height, allowed);
  }
};

TEST_F(CpuReferenceAgainstDevice, GeneratedScenes) {
  for (const char* name : {"boxes", "planes", "teapot"})
    expectReferenceAgrees(loadScene({name, {}, 0.1f}), 160, 90);
}

TEST_F(CpuReferenceAgainstDevice, AllGeneratedScenesAtLowDetail) {
  for (const SceneInfo& info : sceneCatalogue()) {
    const Scene scene = loadScene({info.name, {}, 0.02f});
    expectReferenceAgrees(scene, 128, 72, scene.textures.empty() ? tolerance : textureTolerance);
  }
}

TEST_F(CpuReferenceAgainstDevice, RandomSoupsWithDuplicates) {
  for (const std::uint64_t seed : {1, 2, 3, 4})
    expectReferenceAgrees(randomSoup(seed, 200), 96, 96);
}

// With black glass of one opacity everywhere, what is left of the background tells how many layers
// there are before it.
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

// Inside of things: triangles cross the near plane and reach behind the eye.
TEST_F(CpuReferenceAgainstDevice, ViewsFromInside) {
  const Scene boxes = loadScene({"boxes", {}, 0.1f});
  for (const char* view : {"orbit:0.3,0.2,0.4,90", "orbit:2,-0.7,0.05,120"})
    expectReferenceAgrees(boxes, parseCamera(view, boxes.bounds), 128, 96);
  Scene soup = randomSoup(5, 100);
  Camera camera = frontCamera();
  camera.eye = {0.1f, 0.0f, -0.2f};
  camera.target = {0.3f, 0.1f, -1.0f};
  expectReferenceAgrees(soup, camera, 128, 96);
}

TEST_F(CpuReferenceAgainstDevice, TexturedScenes) {
  OITLAB_NEEDS_SHARED_SCENES();
  for (const char* name : {"oaktree.glb", "flight_helmet.glb", "alpha_blend_mode_test.glb"}) {
    const auto path = sharedScenes() / name;
    if (std::filesystem::exists(path))
      expectReferenceAgrees(loadScene({path.string(), {}, 1.0f}), 160, 120, textureTolerance);
  }
}

// As a method it is what renderOnCpu() gives, in every format.
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
  const MethodInfo& info = findMethod("cpu_reference");
  const auto method = fixture.renderer().prepare(info, Parameters(info.parameters, {}, info.name));
  Camera camera = findView(scene, "default");
  const auto first = fixture.renderer().render(*method, camera).counters;
  EXPECT_EQ(fixture.renderer().render(*method, camera).counters, first) << "cpu_ms too: kept";
  camera.target = camera.eye + (camera.eye - camera.target);
  EXPECT_EQ(fixture.renderer().render(*method, camera).counters.at("fragments"), 0u);
}

}  // namespace
}  // namespace oitlab::testing
