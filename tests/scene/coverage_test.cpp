#include "scene/coverage.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "scene/camera_path.h"
#include "scene/generate/shapes.h"

namespace oitlab {
namespace {

bool near(glm::vec3 a, glm::vec3 b, float tolerance) {
  return glm::distance(a, b) < tolerance;
}

TEST(Coverage, CountsPixelCentres) {
  MeshBuilder builder("quads");
  const std::uint32_t material = builder.blendMaterial(0.5f);
  builder.quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}, glm::vec3(1), material);
  builder.quad({0, 0, -1}, {0, 1, 0}, {1, 0, 0}, glm::vec3(1), material);  // seen from behind
  builder.quad({9, 0, 0}, {1, 0, 0}, {0, 1, 0}, glm::vec3(1), material);   // outside
  builder.quad({0, 0, 3}, {1, 0, 0}, {0, 1, 0}, glm::vec3(1), material);   // behind the eye
  const Scene scene = builder.take();
  const Camera camera{.eye = {0, 0, 1}, .fovY = fullTurn / 4.0f, .near = 0.1f};
  const Coverage coverage = measureCoverage(scene, camera, 40, 20);
  // A pixel is 0.1 wide at distance 1 and 0.2 at distance 2: both quads cover 10 x 10 pixels.
  EXPECT_EQ(coverage.samples, 200u);
  EXPECT_EQ(coverage.coveredPixels, 100u);
  EXPECT_EQ(coverage.peakDepth, 2u);
  EXPECT_EQ(coverage.visible, 4u);
  EXPECT_EQ(coverage.visibleFront, 2u);
}

TEST(Coverage, CutsAtTheNearPlane) {
  MeshBuilder builder("floor");
  const std::uint32_t material = builder.blendMaterial(0.5f);
  builder.quad({0, -1, 0}, {1000, 0, 0}, {0, 0, -1000}, glm::vec3(1), material);
  const Camera camera{.eye = {0, 0, 0.5f}, .target = {0, 0, -1}, .near = 0.01f};
  // The lower half of the frame, except for at most one row at the horizon.
  const double samples = double(measureCoverage(builder.take(), camera, 100, 100).samples);
  EXPECT_NEAR(samples, 5000.0, 100.0);
}

// The figures in docs/scenes.md that the paper's tables use; samples are at 2560x1330.
TEST(Generated, DefaultViewsTakeThePapersSamples) {
  const std::map<std::string, double> samples = {
      {"boxes", 12.11}, {"bunny", 0.74},        {"conference", 5.31}, {"planes", 48.04},
      {"teapot", 1.71}, {"sponza_like", 24.00}, {"scrubpine", 3.26},  {"whiteoak", 122.00}};
  for (const auto& [name, millions] : samples) {
    const Scene scene = loadScene({name});
    const double found =
        double(measureCoverage(scene, findView(scene, "default"), 640, 332).samples);
    const double scaled = found * (2560.0 * 1330.0) / (640.0 * 332.0) * 1e-6;
    EXPECT_NEAR(scaled, millions, (name == "planes" ? 0.03 : 0.2) * millions) << name;
  }
}

TEST(CameraPath, GoesThroughItsKeyframes) {
  const auto at = [](float x, float y) { return Camera{.eye = {x, y, 1}, .target = {x, y, 0}}; };
  const CameraPath path({at(0, 0), at(1, 2), at(2, 0), at(3, 1)});
  EXPECT_TRUE(near(path.at(0).eye, {0, 0, 1}, 1e-5f));
  EXPECT_TRUE(near(path.at(1.0f / 3).eye, {1, 2, 1}, 1e-5f));
  EXPECT_TRUE(near(path.at(2.0f / 3).target, {2, 0, 0}, 1e-5f));
  EXPECT_TRUE(near(path.at(1).eye, {3, 1, 1}, 1e-5f));
  // The speed is constant between equidistant keyframes and does not jump at a keyframe.
  EXPECT_NEAR(path.at(0.5f).eye.x, 1.5f, 1e-5f);
  const float h = 1e-3f, t = 1.0f / 3;
  const glm::vec3 before = (path.at(t).eye - path.at(t - h).eye) / h;
  const glm::vec3 after = (path.at(t + h).eye - path.at(t).eye) / h;
  EXPECT_TRUE(near(before, after, 0.2f));
  EXPECT_EQ(CameraPath({at(5, 5)}).at(0.7f).eye, glm::vec3(5, 5, 1));
}

}  // namespace
}  // namespace oitlab
