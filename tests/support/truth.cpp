#include "support/truth.h"

namespace oitlab::testing {
namespace {

glm::dvec4 colorAt(const CpuImage& image, int x, int y) {
  return image.color[image.index(x, y)];
}

}  // namespace

Verdict judge(const Image& image, const CpuImage& truth, double tolerance, bool hardware) {
  Verdict verdict;
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x) {
      double difference = 0.0;
      for (int c = 0; c < 3; ++c)
        difference =
            std::max(difference, std::abs(double(image.at(x, y)[c]) - colorAt(truth, x, y)[c]));
      const std::uint8_t doubts = truth.doubts[truth.index(x, y)];
      if (doubts == 0) verdict.worst = std::max(verdict.worst, difference);
      const double snapping = hardware ? double(truth.snapping[truth.index(x, y)]) : 0.0;
      if (!(difference <= tolerance + snapping))
        ++(doubts == 0                  ? verdict.wrong
           : doubts & doubt::depthOrder ? verdict.orders
                                        : verdict.edges);
    }
  return verdict;
}

void expectTruth(const Candidate& candidate, const Scene& scene, const Camera& camera, int width,
                 int height, double allowed) {
  SCOPED_TRACE(candidate.method + " on " + scene.name);
  const CpuImage truth = renderOnCpu(scene, camera, width, height);
  RenderFixture fixture(scene, std::uint32_t(width), std::uint32_t(height));
  const auto exact = fixture.render(candidate.method, candidate.parameters, camera);
  const Verdict verdict = judge(exact.image, truth, allowed, candidate.hardware);
  const double pixels = double(width) * height;
  // Every layer has edges near samples. Therefore the shares are of pixels in scenes of few layers,
  // and of fragments in scenes of many layers (hair, pipes).
  const double chances = std::max(pixels, double(truth.fragmentCount()));
  ::testing::Test::RecordProperty(
      scene.name,
      fmt::format("worst {:.4f}/255; in doubt: edge {}, order {}, cutoff {}", verdict.worst * 255,
                  truth.pixelsInDoubt(doubt::edge), truth.pixelsInDoubt(doubt::depthOrder),
                  truth.pixelsInDoubt(doubt::cutoff)));
  EXPECT_EQ(verdict.wrong, 0u) << "worst: " << verdict.worst * 255 << "/255";
  EXPECT_LT(double(verdict.edges), 0.001 * chances);
  // The oak's leaves are cards whose back has the same vertices in another order. Which of the two
  // is in front depends on the device.
  EXPECT_LT(double(verdict.orders), 0.01 * pixels);
  // Most pixels must be without doubt, or nothing was tested.
  EXPECT_LT(double(truth.pixelsInDoubt(0xff)), 0.1 * chances);
  EXPECT_NEAR(double(exact.frame.counters.at("fragments")), double(truth.fragmentCount()),
              double(truth.pixelsInDoubt(doubt::edge | doubt::cutoff)));
}

void expectTruth(const Candidate& candidate, const Scene& scene, int width, int height) {
  expectTruth(candidate, scene, findView(scene, "default"), width, height,
              scene.textures.empty() ? tolerance : textureTolerance);
}

void expectTruthFromInside(const Candidate& candidate) {
  const Scene boxes = loadScene({"boxes", {}, 0.1f});
  for (const char* view : {"orbit:0.3,0.2,0.4,90", "orbit:2,-0.7,0.05,120"})
    expectTruth(candidate, boxes, parseCamera(view, boxes.bounds), 128, 96, tolerance);
  Camera camera = frontCamera();
  camera.eye = {0.1f, 0.0f, -0.2f};
  camera.target = {0.3f, 0.1f, -1.0f};
  expectTruth(candidate, randomSoup(5, 100), camera, 128, 96, tolerance);
}

}  // namespace oitlab::testing
