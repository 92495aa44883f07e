#include "render/depth_complexity.h"

#include "support/gpu.h"

namespace oitlab::testing {
namespace {

class DepthComplexityGpu : public GpuTest {};

TEST(DepthComplexity, ValuesWorkedOutByHand) {
  const DepthComplexity depth(3, 2, {0, 2, 5, 2, 0, 0});
  EXPECT_EQ(depth.total, 9u);
  EXPECT_EQ(depth.covered, 3u);
  EXPECT_EQ(depth.peak, 5u);
  EXPECT_DOUBLE_EQ(depth.meanOfAll(), 1.5);
  EXPECT_DOUBLE_EQ(depth.meanOfCovered(), 3);
  EXPECT_EQ(depth.histogram, (std::vector<std::uint64_t>{3, 0, 2, 0, 0, 1}));
  const DepthComplexity empty(2, 1, {0, 0});
  EXPECT_EQ(empty.meanOfCovered(), 0);
  EXPECT_EQ(empty.histogram, std::vector<std::uint64_t>{2});
}

TEST_F(DepthComplexityGpu, CountsWhatTheReferenceBlends) {
  for (const std::string name : {"boxes", "planes", "teapot"}) {
    RenderFixture fixture(loadScene({name, {}, 0.2f}), 160, 90);
    const DepthComplexity depth = countFragments(fixture.renderer(), fixture.defaultView());
    const auto counters = fixture.render("reference").frame.counters;
    EXPECT_EQ(depth.total, counters.at("fragments")) << name;
    EXPECT_EQ(depth.peak, counters.at("max_fragments_per_pixel")) << name;
    EXPECT_EQ(depth.covered, counters.at("covered_pixels")) << name;
    EXPECT_GT(depth.peak, 1u) << name;
  }
}

TEST_F(DepthComplexityGpu, ASheetIsOneEverywhereAndTwiceIsNoMore) {
  constexpr int cells = 23;
  std::vector<std::array<glm::vec3, 3>> triangles;
  const auto corner = [&](int x, int y) {
    return glm::vec3(-40.0f + 80.0f * float(x) / cells, -40.0f + 80.0f * float(y) / cells, 0.0f);
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      triangles.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
      triangles.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
    }
  RenderFixture fixture(triangleScene(triangles, {{1, 1, 1, 0.5f}}, frontCamera()), 101, 67);
  // A second frame must not add to the first.
  for (int frame = 0; frame < 2; ++frame) {
    const DepthComplexity depth = countFragments(fixture.renderer(), fixture.defaultView());
    EXPECT_EQ(depth.counts, std::vector<std::uint32_t>(101 * 67, 1u));
  }
}

// Two layers, one of them behind an opaque layer that covers the right half.
TEST_F(DepthComplexityGpu, OpaqueGeometryHidesWhatIsBehindIt) {
  const auto layer = [](float left, float z) {
    return std::array{glm::vec3{left, -99, z}, glm::vec3{left, 99, z}, glm::vec3{200, 0, z}};
  };
  Scene scene = triangleScene({layer(-99, 0), layer(0, -1), layer(-99, -2)},
                              {{1, 0, 0, 0.5f}, {0, 1, 0, 1}, {0, 0, 1, 0.5f}}, frontCamera());
  scene.materials.emplace_back();
  for (int corner = 0; corner < 3; ++corner)
    scene.vertices[scene.triangles[1][corner]].material = 1;
  RenderFixture fixture(scene, 16, 12);
  const DepthComplexity depth = countFragments(fixture.renderer(), fixture.defaultView());
  for (std::uint32_t y = 0; y < 12; ++y)
    for (std::uint32_t x = 0; x < 16; ++x)
      EXPECT_EQ(depth.counts[y * 16 + x], x < 8 ? 2u : 1u) << x << ", " << y;
}

// Fragments that the alpha cutoff discards do not count, because no method blends them.
TEST_F(DepthComplexityGpu, CutAwayFragmentsAreNotCounted) {
  const auto layer = [](float z) {
    return std::array{glm::vec3{-99, -99, z}, glm::vec3{99, -99, z}, glm::vec3{0, 99, z}};
  };
  Scene scene = triangleScene({layer(0), layer(-1), layer(-2)},
                              {{1, 1, 1, 0.25f}, {1, 1, 1, 0.75f}, {1, 1, 1, 0.5f}}, frontCamera());
  scene.materials[0].alphaCutoff = 0.4f;
  RenderFixture fixture(scene, 9, 7);
  const DepthComplexity depth = countFragments(fixture.renderer(), fixture.defaultView());
  EXPECT_EQ(depth.counts, std::vector<std::uint32_t>(9 * 7, 2u));
}

}  // namespace
}  // namespace oitlab::testing
