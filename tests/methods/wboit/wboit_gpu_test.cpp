// WBOIT is exact for one layer and independent of order, and its weights vary with depth.
#include <gmock/gmock.h>

#include "quality/compare.h"
#include "support/gpu.h"

namespace oitlab::testing {
namespace {

class Wboit : public GpuTest {};

const std::map<std::string, std::string> fullFloat = {{"accum_format", "rgba32f"},
                                                      {"reveal_format", "r32f"}};

std::map<std::string, std::string> with(const std::string& name, const std::string& value) {
  auto parameters = fullFloat;
  parameters[name] = value;
  return parameters;
}

/// A triangle across the view axis of frontCamera(), at `distance` from the eye.
std::array<glm::vec3, 3> across(float distance) {
  const float z = frontCamera().eye.z - distance;
  return {glm::vec3{-distance, -distance, z}, {distance, -distance, z}, {0, distance, z}};
}

TEST_F(Wboit, OneLayerIsExactWhateverTheWeight) {
  const Scene scene = triangleScene({across(1)}, {{0.9f, 0.5f, 0.1f, 0.4f}}, frontCamera());
  RenderFixture fixture(scene, 64, 48);
  const auto exact = fixture.render("reference");
  for (const char* weight : {"eq7", "eq8", "eq9", "eq10", "none"}) {
    const auto result = fixture.render("wboit", with("weight", weight));
    EXPECT_LT(compareImages(result.image, exact.image).maxError, 1e-5) << weight;
    EXPECT_EQ(result.frame.counters.at("fragments"), exact.frame.counters.at("fragments"));
  }
  // Half floats round colour and alpha to 11 bits, an 8-bit revealage to 8 bits.
  EXPECT_LT(compareImages(fixture.render("wboit").image, exact.image).maxError, 1e-3);
  const auto coarse = fixture.render("wboit", {{"reveal_format", "r8"}});
  EXPECT_LT(compareImages(coarse.image, exact.image).maxError, 1.0 / 255);
}

/// The ratio of the weights of a layer at `nearest` and one at `farthest`. Both have the same
/// alpha, so it is the ratio of their colours in the mean.
double weightRatio(const std::string& weight, float nearest, float farthest) {
  Camera camera = frontCamera();
  camera.near = 0.5f * nearest;
  const Scene scene = triangleScene({across(nearest), across(farthest)},
                                    {{1, 0, 0, 0.5f}, {0, 0, 1, 0.5f}}, camera);
  RenderFixture fixture(scene, 33, 33);
  const Image image = fixture.render("wboit", with("weight", weight)).image;
  const float* center = image.at(16, 16);
  const double alpha = 128 / 255.0;  // as stored in 8 bits
  const double behind = (1 - alpha) * (1 - alpha) * backgroundColor.r;
  return (center[0] - behind) / (center[2] - behind);
}

// If a weight is clamped to a constant over the depths of a scene, the mean does not depend on
// order.
TEST_F(Wboit, WeightsVaryOverTheDepthsOfEveryScene) {
  for (const SceneInfo& info : sceneCatalogue()) {
    const Scene scene = loadScene({info.name, {}, 0.01f});
    const Camera camera = findView(scene, "default");
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    const float middle = glm::dot(scene.bounds.center() - camera.eye, forward);
    const float farthest = middle + scene.bounds.radius();
    const float nearest = std::max(middle - scene.bounds.radius(), 0.02f * farthest);
    for (const char* weight : {"eq7", "eq8", "eq9", "eq10"})
      EXPECT_GT(weightRatio(weight, nearest, farthest), 1.2) << info.name << " " << weight;
    EXPECT_NEAR(weightRatio("none", nearest, farthest), 1.0, 1e-3) << info.name;
  }
}

// The published weights, implemented here a second time. The scene's farthest point is at 150, 95
// and 250 of the paper's units (see rangeOf() in methods/wboit).
TEST_F(Wboit, EquationsAreAsPublished) {
  auto equation7 = [](double z) {
    return std::clamp(10.0 / (1e-5 + std::pow(z / 5, 2) + std::pow(z / 200, 6)), 1e-2, 3e3);
  };
  auto equation8 = [](double z) {
    return std::clamp(10.0 / (1e-5 + std::pow(z / 10, 3) + std::pow(z / 200, 6)), 1e-2, 3e3);
  };
  auto equation9 = [](double z) {
    return std::clamp(0.03 / (1e-5 + std::pow(z / 200, 4)), 1e-2, 3e3);
  };
  for (const double near : {0.3, 0.7}) {
    const auto expectRatio = [&](const char* weight, double expected) {
      EXPECT_NEAR(weightRatio(weight, float(near), 1.0f) / expected, 1.0, 0.01) << weight;
    };
    expectRatio("eq7", equation7(150 * near) / equation7(150));
    expectRatio("eq8", equation8(95 * near) / equation8(95));
    expectRatio("eq9", equation9(250 * near) / equation9(250));
  }
}

TEST_F(Wboit, SubmissionOrderOnlyRounds) {
  const Scene scene = loadScene({"boxes", {}, 0.1f});
  const Image plain = RenderFixture(scene, 96, 54).render("wboit", fullFloat).image;
  for (const std::uint64_t seed : {1, 2}) {
    const Image shuffled = RenderFixture(scene, 96, 54, seed).render("wboit", fullFloat).image;
    EXPECT_LT(compareImages(shuffled, plain).maxError, 1e-3);
  }
}

// For many layers it is an estimate, and weights that depend on depth make it better.
TEST_F(Wboit, WeightsBringItNearerToTheExactImage) {
  RenderFixture fixture(loadScene({"boxes", {}, 1.0f}), 96, 54);
  const Image exact = fixture.render("reference").image;
  auto errorOf = [&](const char* weight) {
    return compareImages(fixture.render("wboit", with("weight", weight)).image, exact).rmse;
  };
  for (const char* weight : {"eq7", "eq8", "eq9", "eq10"}) {
    EXPECT_GT(errorOf(weight), 1e-3) << weight;
    EXPECT_LT(errorOf(weight), 0.95 * errorOf("none")) << weight;
  }
}

}  // namespace
}  // namespace oitlab::testing
