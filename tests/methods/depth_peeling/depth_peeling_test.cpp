// Depth peeling with all layers gives the reference's image bit for bit. With fewer it counts what
// it missed.
#include "support/gpu.h"

#include "quality/compare.h"
#include "render/depth_complexity.h"

namespace oitlab::testing {
namespace {

class DepthPeeling : public GpuTest {};

using Parameterization = std::map<std::string, std::string>;

const std::vector<Parameterization> everyExactVariant = {
    {{"atomics", "int64"}},
    {{"atomics", "int32"}},
    {{"atomics", "int64"}, {"mode", "dual"}},
    {{"atomics", "int32"}, {"mode", "dual"}},
};

std::string labelOf(const Parameterization& parameters) {
  std::string label;
  for (const auto& [name, value] : parameters) label += name + "=" + value + " ";
  return label;
}

/// A triangle that covers frontCamera()'s view at this z.
std::array<glm::vec3, 3> across(float z) {
  return {glm::vec3{-99, -99, z}, {99, -99, z}, {0, 99, z}};
}

/// One colour per layer, all different.
std::vector<glm::vec4> colors(int count, float alpha) {
  std::vector<glm::vec4> colors;
  for (int i = 0; i < count; ++i)
    colors.emplace_back(float(i % 7) / 6, float(i % 11) / 10, float(i % 13) / 12, alpha);
  return colors;
}

TEST_F(DepthPeeling, IsTheReferenceOnEveryScene) {
  for (const SceneInfo& info : sceneCatalogue()) {
    RenderFixture fixture(loadScene({info.name, {}, 0.01f}), 64, 36);
    const auto exact = fixture.render("reference");
    for (const char* mode : {"front_to_back", "dual"}) {
      const auto peeled = fixture.render("depth_peeling", {{"mode", mode}});
      EXPECT_EQ(peeled.hash, exact.hash) << info.name << " " << mode;
      const auto& counters = peeled.frame.counters;
      const std::uint64_t layers = exact.frame.counters.at("max_fragments_per_pixel");
      EXPECT_EQ(counters.at("layers"), layers) << info.name << " " << mode;
      EXPECT_EQ(counters.at("fragments"), exact.frame.counters.at("fragments")) << info.name;
      EXPECT_EQ(counters.at("missed_fragments"), 0u) << info.name;
    }
  }
}

// Fragments with an alpha below the cutoff do not count as layers.
TEST_F(DepthPeeling, HolesOfACutoffAreNoLayers) {
  Scene scene = randomSoup(24, 60);
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    scene.vertices[i].color = packColor({0.9f, 0.4f, 0.1f, i % 3 == 0 ? 0.0f : 0.8f});
  const auto whole = RenderFixture(scene, 48, 48).render("reference");
  scene.materials[0].alphaCutoff = 0.4f;
  RenderFixture fixture(scene, 48, 48);
  const auto exact = fixture.render("reference");
  ASSERT_LT(exact.frame.counters.at("fragments"), whole.frame.counters.at("fragments"));
  for (const Parameterization& variant : everyExactVariant) {
    const auto peeled = fixture.render("depth_peeling", variant);
    EXPECT_EQ(peeled.hash, exact.hash) << labelOf(variant);
    EXPECT_EQ(peeled.frame.counters.at("fragments"), exact.frame.counters.at("fragments"));
  }
}

// Random triangles, a quarter of them at the depth of another one, in several orders of submission
// and several runs.
TEST_F(DepthPeeling, IsTheReferenceOnRandomSoupsHoweverSubmitted) {
  for (const std::uint64_t seed : {21, 22, 23}) {
    const Scene soup = randomSoup(seed, 60);
    const std::string exact = RenderFixture(soup, 48, 48).render("reference").hash;
    for (const std::optional<std::uint64_t> shuffle : {std::optional<std::uint64_t>{}, {1}, {2}}) {
      RenderFixture fixture(soup, 48, 48, shuffle);
      for (const Parameterization& variant : everyExactVariant)
        for (const int again : {0, 1})
          EXPECT_EQ(fixture.render("depth_peeling", variant).hash, exact)
              << labelOf(variant) << "soup " << seed << ", shuffled with seed "
              << shuffle.value_or(0) << ", time " << again;
    }
  }
}

// With the depth test alone only one of them would be kept.
TEST_F(DepthPeeling, CoplanarFragmentsAreAllLayers) {
  const Scene scene = triangleScene(std::vector(20, across(0)), colors(20, 0.2f), frontCamera());
  const std::string exact = RenderFixture(scene, 16, 16).render("reference").hash;
  for (const std::uint64_t shuffle : {1, 2}) {
    RenderFixture fixture(scene, 16, 16, shuffle);
    for (const Parameterization& variant : everyExactVariant) {
      const auto peeled = fixture.render("depth_peeling", variant);
      EXPECT_EQ(peeled.hash, exact) << labelOf(variant);
      EXPECT_EQ(peeled.frame.counters.at("layers"), 20u) << labelOf(variant);
    }
  }
}

// The passes of Everitt's method, and one that finds the first layer; half as many from both ends.
// Without 64-bit atomics there is another pass per layer.
TEST_F(DepthPeeling, CountsItsPasses) {
  RenderFixture fixture(triangleScene({across(0), across(-1), across(-2), across(-3), across(-4)},
                                      colors(5, 0.5f), frontCamera()),
                        16, 16);
  const std::vector<std::uint64_t> passes = {6, 11, 4, 7};
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const auto peeled = fixture.render("depth_peeling", everyExactVariant[i]);
    EXPECT_EQ(peeled.frame.counters.at("passes"), passes[i]) << labelOf(everyExactVariant[i]);
    EXPECT_EQ(peeled.frame.counters.at("layers"), 5u) << labelOf(everyExactVariant[i]);
  }
}

// With a limited number of layers the image is exactly that of these layers alone: the nearest
// ones, or in dual mode those that are nearest to either end.
TEST_F(DepthPeeling, FewerLayersAreTheNearestOfAnEnd) {
  const std::vector<glm::vec4> all = colors(5, 0.4f);
  const auto exactOf = [&](const std::vector<int>& layers) {
    std::vector<std::array<glm::vec3, 3>> triangles;
    std::vector<glm::vec4> chosen;
    for (const int layer : layers) {
      triangles.push_back(across(-float(layer)));
      chosen.push_back(all[std::size_t(layer)]);
    }
    return RenderFixture(triangleScene(triangles, chosen, frontCamera()), 16, 16)
        .render("reference")
        .hash;
  };
  RenderFixture fixture(triangleScene({across(0), across(-1), across(-2), across(-3), across(-4)},
                                      all, frontCamera()),
                        16, 16);
  struct Case {
    const char* mode;
    const char* layers;
    std::vector<int> kept;
  };
  const std::vector<Case> cases = {
      {"front_to_back", "1", {0}},
      {"front_to_back", "3", {0, 1, 2}},
      {"front_to_back", "9", {0, 1, 2, 3, 4}},
      {"dual", "1", {0}},
      {"dual", "2", {0, 4}},
      {"dual", "3", {0, 1, 4}},
      {"dual", "4", {0, 1, 3, 4}},
      {"dual", "9", {0, 1, 2, 3, 4}},
  };
  for (const Case& wanted : cases)
    for (const char* atomics : {"int64", "int32"}) {
      const auto peeled =
          fixture.render("depth_peeling",
                         {{"mode", wanted.mode}, {"layers", wanted.layers}, {"atomics", atomics}});
      const std::string label = std::string(wanted.mode) + " " + wanted.layers + " " + atomics;
      EXPECT_EQ(peeled.hash, exactOf(wanted.kept)) << label;
      EXPECT_EQ(peeled.frame.counters.at("layers"), wanted.kept.size()) << label;
      EXPECT_EQ(peeled.frame.counters.at("missed_fragments"), (5 - wanted.kept.size()) * 16 * 16)
          << label;
    }
}

TEST_F(DepthPeeling, CountsTheFragmentsThatItMissed) {
  RenderFixture fixture(loadScene({"boxes", {}, 0.05f}), 64, 36);
  const DepthComplexity depth = countFragments(fixture.renderer(), fixture.defaultView());
  ASSERT_GT(depth.peak, 5u);
  for (const std::uint32_t layers : {1u, 2u, 5u}) {
    std::uint64_t missed = 0;
    for (const std::uint32_t count : depth.counts) missed += count > layers ? count - layers : 0;
    for (const char* mode : {"front_to_back", "dual"}) {
      const auto peeled =
          fixture.render("depth_peeling", {{"mode", mode}, {"layers", std::to_string(layers)}});
      EXPECT_EQ(peeled.frame.counters.at("missed_fragments"), missed) << mode << " " << layers;
      EXPECT_EQ(peeled.frame.counters.at("fragments"), depth.total) << mode << " " << layers;
      EXPECT_EQ(peeled.frame.counters.at("layers"), layers) << mode;
    }
  }
}

// Blended as published, the back half is rounded in another order: one or two float32 units per
// layer.
TEST_F(DepthPeeling, DualBlendingOfTheBackOnlyRounds) {
  RenderFixture fixture(loadScene({"boxes", {}, 0.05f}), 64, 36);
  const auto exact = fixture.render("reference");
  const auto peeled = fixture.render("depth_peeling", {{"mode", "dual"}, {"back", "blend"}});
  const double worst = compareImages(peeled.image, exact.image).maxError;
  // Each of at most 18 layers rounds its products and sums below 1 by 2^-24 a step.
  EXPECT_LT(worst, 18 * 4 * std::exp2(-24));
  EXPECT_GT(worst, 0) << "the exact order: list and blend would be the same thing";
  EXPECT_EQ(peeled.frame.counters.at("missed_fragments"), 0u);
}

// More passes than the first recording has, while half of the pixels need only one. Then the same
// method object with a moving camera: each frame has exactly the passes that it needs.
TEST_F(DepthPeeling, FindsTheNumberOfPasses) {
  std::vector<std::array<glm::vec3, 3>> layers = {across(-9)};
  for (int i = 0; i < 299; ++i) {
    const float z = -0.01f * float((i * 127) % 299);  // a permutation: 127 is prime
    layers.push_back({glm::vec3{0, -99, z}, {0, 99, z}, {-99, 0, z}});
  }
  RenderFixture fixture(triangleScene(layers, colors(300, 0.02f), frontCamera()), 8, 8);
  Camera away = frontCamera();
  away.target = {0, 0, 2};
  const auto exact = fixture.render("reference");
  for (const char* mode : {"front_to_back", "dual"}) {
    const MethodInfo info = findMethod("depth_peeling");
    const auto method = fixture.renderer().make(
        info, Parameters(info.parameters, {{"mode", mode}, {"atomics", "int64"}}, info.name));
    const std::uint64_t passes = std::string(mode) == "dual" ? 151 : 301;
    const auto renderFront = [&] {
      const FrameResult frame = fixture.renderer().render(*method, frontCamera(), true);
      EXPECT_EQ(frame.counters.at("layers"), 300u) << mode;
      EXPECT_EQ(frame.counters.at("passes"), passes) << mode;
      EXPECT_EQ(imageHash(fixture.renderer().target().readBytes(sharedDevice())), exact.hash);
      return frame.recordings;
    };
    EXPECT_GT(renderFront(), 1) << mode;
    EXPECT_EQ(renderFront(), 1) << mode;
    const FrameResult empty = fixture.renderer().render(*method, away, true);
    EXPECT_EQ(empty.recordings, 1) << mode;
    EXPECT_EQ(empty.counters.at("layers"), 0u) << mode;
    EXPECT_EQ(empty.counters.at("passes"), 1u) << mode;
    EXPECT_GT(renderFront(), 1) << mode;
  }
}

}  // namespace
}  // namespace oitlab::testing
