// The methods on the device. Those that claim to be exact are, in every run and for shuffled input.
#include "support/gpu.h"

#include <gmock/gmock.h>

#include "gpu/pipeline_cache.h"
#include "quality/compare.h"

namespace oitlab::testing {
namespace {

class Methods : public GpuTest {};

Scene generated(const std::string& name, float detail = 1.0f) {
  return loadScene({name, {}, detail});
}

float centerChannel(const Image& image, int channel) {
  return image.at(image.width / 2, image.height / 2)[channel];
}

// Two layers, computed by hand: over = a1 c1 + (1 - a1)(a2 c2 + (1 - a2) background).
TEST_F(Methods, TwoLayersBlendAsWorkedOutByHand) {
  const std::array<glm::vec3, 3> far = {glm::vec3{-9, -9, -1}, {9, -9, -1}, {0, 9, -1}};
  const std::array<glm::vec3, 3> near = {glm::vec3{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
  const glm::vec4 red{1, 0, 0, 0.5f}, green{0, 1, 0, 0.25f};
  // The nearer layer comes first: wrong for blending in submission order, right for the reference.
  RenderFixture fixture(triangleScene({near, far}, {red, green}, frontCamera()), 17, 11);
  const auto exact = fixture.render("reference");
  // shade() gives 0.2 + 0.8 * (0.5 + 0.5 * 0.4206) for the normal (0, 0, 1).
  const float light = 0.2f + 0.8f * (0.5f + 0.5f * 0.4206f);
  const float redAlpha = 128 / 255.0f, greenAlpha = 64 / 255.0f;  // as stored in 8 bits
  const float transmitted = (1 - redAlpha) * (1 - greenAlpha) * backgroundColor.r;
  EXPECT_NEAR(centerChannel(exact.image, 0), redAlpha * light + transmitted, 1e-5f);
  EXPECT_NEAR(centerChannel(exact.image, 1), (1 - redAlpha) * greenAlpha * light + transmitted,
              1e-5f);
  EXPECT_NEAR(centerChannel(exact.image, 2), transmitted, 1e-5f);
  EXPECT_EQ(exact.frame.counters.at("fragments"), 2u * 17 * 11);
  EXPECT_EQ(exact.frame.counters.at("max_fragments_per_pixel"), 2u);
  EXPECT_EQ(exact.frame.counters.at("covered_pixels"), 17u * 11);

  const auto sorted = fixture.render("blend", {{"order", "sorted"}});
  EXPECT_LT(compareImages(sorted.image, exact.image).maxError, 1e-5);
  const auto submitted = fixture.render("blend", {{"order", "submission"}});
  EXPECT_GT(compareImages(submitted.image, exact.image).maxError, 0.05);
}

TEST_F(Methods, ReferenceIsTheSameUnderShuffledSubmissionAndFromRunToRun) {
  for (const std::string name : {"boxes", "planes", "teapot"}) {
    const Scene scene = generated(name, 0.1f);
    RenderFixture plain(scene, 160, 90);
    const std::string hash = plain.render("reference").hash;
    EXPECT_EQ(plain.render("reference").hash, hash) << name << ", rendered again";
    for (const std::uint64_t seed : {1, 2, 3})
      EXPECT_EQ(RenderFixture(scene, 160, 90, seed).render("reference").hash, hash)
          << name << ", shuffled with seed " << seed;
  }
}

TEST_F(Methods, ReferenceOrdersEqualDepthsByPrimitiveId) {
  for (const std::uint64_t seed : {11, 12}) {
    const Scene soup = randomSoup(seed, 120);
    const std::string hash = RenderFixture(soup, 64, 64).render("reference").hash;
    for (const std::uint64_t shuffle : {1, 2, 3})
      EXPECT_EQ(RenderFixture(soup, 64, 64, shuffle).render("reference").hash, hash)
          << "soup " << seed << ", shuffled with seed " << shuffle;
  }
}

// Fixed-function blending of the same fragments in the exact order: for parallel planes the order
// of their centroids is right.
TEST_F(Methods, SortedBlendingOfParallelPlanesIsTheReference) {
  RenderFixture fixture(generated("planes"), 160, 90);
  const auto exact = fixture.render("reference");
  const auto sorted = fixture.render("blend", {{"order", "sorted"}});
  const Comparison c = compareImages(sorted.image, exact.image);
  EXPECT_LT(c.maxError, 1e-4);
  EXPECT_EQ(sorted.frame.counters.at("fragments"), exact.frame.counters.at("fragments"));
}

TEST_F(Methods, ReferenceGrowsItsPoolAndLosesNothing) {
  RenderFixture fixture(generated("planes"), 96, 64);
  const auto roomy = fixture.render("reference", {{"initial_depth", "64"}});
  const auto tight = fixture.render("reference", {{"initial_depth", "0"}});
  EXPECT_EQ(roomy.frame.recordings, 1);
  EXPECT_EQ(tight.frame.recordings, 2);
  EXPECT_EQ(tight.hash, roomy.hash);
  EXPECT_EQ(tight.frame.counters, roomy.frame.counters);
}

// The number of fragments per pixel has no limit: 3,000 layers over the left half, which need
// several rounds of the sort, beside pixels of a single layer, which need only the first.
TEST_F(Methods, ReferenceSortsThousandsOfLayers) {
  std::vector<std::array<glm::vec3, 3>> layers;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < 2999; ++i) {
    const float z = -0.001f * float((i * 7919) % 2999);  // a permutation: 7919 is prime
    layers.push_back({glm::vec3{0, -99, z}, {0, 99, z}, {-99, 0, z}});
    colors.emplace_back(float(i % 7) / 6, float(i % 11) / 10, float(i % 13) / 12, 0.01f);
  }
  layers.push_back({glm::vec3{-99, -99, -4}, {99, -99, -4}, {0, 99, -4}});
  colors.emplace_back(0.2f, 0.9f, 0.4f, 0.5f);
  const Scene scene = triangleScene(layers, colors, frontCamera());
  RenderFixture fixture(scene, 8, 8);
  const auto exact = fixture.render("reference");
  EXPECT_GT(exact.frame.recordings, 1);
  EXPECT_EQ(exact.frame.counters.at("fragments"), 2999u * 32 + 64);
  EXPECT_EQ(exact.frame.counters.at("max_fragments_per_pixel"), 3000u);
  EXPECT_EQ(exact.frame.counters.at("covered_pixels"), 64u);
  const auto sorted = fixture.render("blend", {{"order", "sorted"}});
  // Blending back to front in float32 rounds 3,000 times in another order.
  EXPECT_LT(compareImages(sorted.image, exact.image).maxError, 1e-3);
}

// A closed sheet of small triangles, also at a grazing angle: each pixel is covered exactly once,
// also at shared edges.
TEST_F(Methods, TessellatedSheetCoversEveryPixelOnce) {
  constexpr int cells = 37;
  std::vector<std::array<glm::vec3, 3>> triangles;
  auto corner = [&](int x, int y) {
    return glm::vec3(-40.0f + 80.0f * float(x) / cells, -40.0f + 80.0f * float(y) / cells, 0.0f);
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      triangles.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
      triangles.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
    }
  RenderFixture fixture(triangleScene(triangles, {{1, 1, 1, 0.5f}}, frontCamera()), 101, 67);
  for (const float tilt : {0.0f, 0.2f, 0.4f}) {
    Camera camera = frontCamera();
    camera.eye = {tilt, 0.3f * tilt, 1.0f};
    const auto exact = fixture.render("reference", {}, camera);
    EXPECT_EQ(exact.frame.counters.at("max_fragments_per_pixel"), 1u) << tilt;
    EXPECT_EQ(exact.frame.counters.at("fragments"), 101u * 67) << tilt;
  }
}

// Opaque geometry hides layers behind it and is visible through layers in front of it.
TEST_F(Methods, TransparentFragmentsAreTestedAgainstOpaqueDepth) {
  const auto layer = [](float z) {
    return std::array{glm::vec3{-9, -9, z}, glm::vec3{9, -9, z}, glm::vec3{0, 9, z}};
  };
  Scene scene = triangleScene({layer(0), layer(-1), layer(-2)},
                              {{1, 0, 0, 0.5f}, {0, 1, 0, 1}, {0, 0, 1, 0.5f}}, frontCamera());
  Material opaque;
  scene.materials.push_back(opaque);
  for (int corner = 0; corner < 3; ++corner)
    scene.vertices[scene.triangles[1][corner]].material = 1;
  RenderFixture fixture(scene, 16, 16);
  const auto exact = fixture.render("reference");
  EXPECT_EQ(exact.frame.counters.at("fragments"), 16u * 16);
  EXPECT_FLOAT_EQ(centerChannel(exact.image, 2), 0.0f);
  EXPECT_GT(centerChannel(exact.image, 1), 0.2f);
  const auto blended = fixture.render("blend");
  EXPECT_LT(compareImages(blended.image, exact.image).maxError, 1e-5);
}

TEST_F(Methods, EveryTargetFormatHoldsTheSamePicture) {
  const Scene scene = generated("boxes", 0.05f);
  const auto exact = RenderFixture(scene, 80, 45).render("reference");
  for (const TargetFormat format : {TargetFormat::rgba16f, TargetFormat::rgba8}) {
    const auto other = RenderFixture(scene, 80, 45, {}, format).render("reference");
    EXPECT_LT(compareImages(other.image, exact.image).maxError, 1.0 / 255) << formatName(format);
  }
}

TEST_F(Methods, AnEmptyViewIsTheBackground) {
  Camera away = frontCamera();
  away.eye = {0, 0, 5};
  away.target = {0, 0, 6};
  RenderFixture fixture(randomSoup(1, 8), 33, 9);
  for (const auto& [name, info] : methods()) {
    const auto result = fixture.render(name, {}, away);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_FLOAT_EQ(centerChannel(result.image, channel), backgroundColor[channel]) << name;
  }
}

// Drivers compile slowly, so a method that is made a second time, for any scene, uses the pipelines
// of the first. A method for another target format has other pipelines, because its shaders depend
// on the format.
TEST_F(Methods, PipelinesAreMadeOnce) {
  const auto& pipelines = sharedDevice().pipelines();
  RenderFixture fixture(randomSoup(1, 10), 8, 8), other(randomSoup(2, 10), 9, 7);
  RenderFixture half(randomSoup(1, 10), 8, 8, {}, TargetFormat::rgba16f);
  for (const auto& [name, info] : methods()) {
    if (!info.missing(sharedDevice().info()).empty()) continue;
    fixture.make(name);
    const std::size_t made = pipelines.size();
    fixture.make(name);
    other.make(name);
    EXPECT_EQ(pipelines.size(), made) << name;
  }
  // lucid makes a program when a frame first needs it.
  const std::map<std::string, std::string> filter2 = {{"depth_filter", "2"},
                                                      {"ordered_first", "off"}};
  const std::map<std::string, std::string> filter4 = {{"depth_filter", "4"},
                                                      {"ordered_first", "off"}};
  fixture.render("lucid", filter2);
  const std::size_t before = pipelines.size();
  fixture.render("lucid", filter4);
  EXPECT_GT(pipelines.size(), before);
  const std::size_t made = pipelines.size();
  other.render("lucid", filter4);
  EXPECT_EQ(pipelines.size(), made);
  half.render("lucid", filter4);
  EXPECT_GT(pipelines.size(), made);
}

TEST_F(Methods, MemoryIsListedByBuffer) {
  RenderFixture fixture(generated("planes"), 64, 32);
  const MethodInfo info = findMethod("reference");
  const auto method = fixture.renderer().make(
      info, Parameters(info.parameters, {{"initial_depth", "2"}}, info.name));
  const auto& buffers = method->memory().byName();
  EXPECT_EQ(buffers.at("list heads"), 64u * 32 * 4);
  EXPECT_EQ(buffers.at("fragment nodes"), (2u * 64 * 32 + 1) * 28);
}

}  // namespace
}  // namespace oitlab::testing
