// LucidRaster: right, exact, and the same under every choice that must not show.
#include <gmock/gmock.h>

#include "quality/compare.h"
#include "support/shared_scenes.h"
#include "support/truth.h"
#include "util/random.h"

namespace oitlab::testing {
namespace {

const Candidate lucid{"lucid"};

class Lucid : public GpuTest {};

TEST_F(Lucid, AgreesWithTheCpuOnEveryGeneratedScene) {
  for (const SceneInfo& info : sceneCatalogue())
    expectTruth(lucid, loadScene({info.name, {}, 0.02f}), 128, 72);
}

TEST_F(Lucid, AgreesWithTheCpuOnRandomSoups) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) expectTruth(lucid, randomSoup(seed, 200), 96, 96);
}

TEST_F(Lucid, AgreesWithTheCpuFromInside) {
  expectTruthFromInside(lucid);
}

TEST_F(Lucid, AgreesWithTheCpuOnFiles) {
  OITLAB_NEEDS_SHARED_SCENES();
  for (const char* name : {"sponza.glb", "oaktree.glb", "alpha_blend_mode_test.glb"}) {
    const auto path = sharedScenes() / name;
    if (std::filesystem::exists(path))
      expectTruth(lucid, loadScene({path.string(), 0.5f, 1.0f}), 160, 120);
  }
}

using Choice = std::map<std::string, std::string>;

/// Scenes in which the order of tri-half-blocks is often wrong.
std::vector<Scene> disorderly() {
  std::vector<Scene> scenes = {randomSoup(21, 300)};
  for (const char* name : {"whiteoak", "hairball", "boxes"})
    scenes.push_back(loadScene({name, {}, 0.02f}));
  return scenes;
}

// With the repair neither the filter nor the division of work shows, bit for bit; nor does the
// order of submission, nor a second run.
TEST_F(Lucid, IsOneImageForEveryFilterShuffleAndRun) {
  for (const Scene& scene : disorderly()) {
    RenderFixture fixture(scene, 160, 90);
    const auto first = fixture.render("lucid");
    EXPECT_EQ(fixture.render("lucid").hash, first.hash) << scene.name << ", rendered again";
    for (const char* filter : {"1", "2", "8", "16"})
      EXPECT_EQ(fixture.render("lucid", {{"depth_filter", filter}}).hash, first.hash)
          << scene.name << ", depth filter " << filter;
    for (const std::uint64_t seed : {1, 2})
      EXPECT_EQ(RenderFixture(scene, 160, 90, seed).render("lucid").hash, first.hash)
          << scene.name << ", shuffled with seed " << seed;
  }
}

TEST_F(Lucid, WrongPixelsFallAsTheFilterGrowsAndTheRepairMendsThemAll) {
  RenderFixture fixture(loadScene({"whiteoak", {}, 0.02f}), 160, 90);
  const Image exact = fixture.render("lucid").image;
  std::uint64_t before = ~0ull, repaired = 0;
  for (const char* filter : {"1", "3", "8", "12"}) {
    const auto rough = fixture.render("lucid", {{"depth_filter", filter}, {"repair", "off"}});
    const std::uint64_t invalid = rough.frame.counters.at("invalid_pixels");
    EXPECT_LT(invalid, before) << filter;
    EXPECT_EQ(rough.frame.counters.at("repaired_pixels"), 0u);
    // Every pixel that differs was noticed.
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < exact.rgba.size(); i += 4)
      different += !std::equal(&exact.rgba[i], &exact.rgba[i] + 4, &rough.image.rgba[i]);
    EXPECT_LE(different, invalid) << filter;
    if (before == ~0ull) {
      EXPECT_GT(different, 100u) << "nothing was wrong, and nothing tested";
    }
    repaired =
        fixture.render("lucid", {{"depth_filter", filter}}).frame.counters.at("repaired_pixels");
    EXPECT_EQ(repaired, invalid) << filter;
    before = invalid;
  }
}

TEST_F(Lucid, ShowsErrorsInRed) {
  RenderFixture fixture(loadScene({"whiteoak", {}, 0.02f}), 160, 90);
  const auto shown = fixture.render("lucid", {{"depth_filter", "1"}, {"visualize_errors", "on"}});
  std::uint64_t red = 0;
  for (std::size_t i = 0; i < shown.image.rgba.size(); i += 4)
    red += shown.image.rgba[i] == 1.0f && shown.image.rgba[i + 1] == 0.0f;
  EXPECT_EQ(red, shown.frame.counters.at("invalid_pixels"));
  EXPECT_GT(red, 0u);
}

/// A sheet of `cells` x `cells` quads over [-size, size] in the plane z = 0.
Scene sheet(int cells, float size) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  auto corner = [&](int x, int y) {
    return glm::vec3(size * (2.0f * float(x) / float(cells) - 1.0f),
                     size * (2.0f * float(y) / float(cells) - 1.0f), 0.0f);
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      triangles.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
      triangles.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
    }
  return triangleScene(triangles, {{0, 0, 0, 0.5f}}, frontCamera());
}

std::uint64_t pixelsOf(const Image& image, float red) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    count += std::abs(image.rgba[i] - red) < 1e-3f;
  return count;
}

// Watertight: below the horizon each pixel has one layer, above it none; edges in front of and
// behind the eye, and vertices on samples.
TEST_F(Lucid, TessellatedSheetCoversEveryPixelOnce) {
  const float once = (1.0f - 128 / 255.0f) * backgroundColor.r;
  for (const int cells : {1, 8, 37}) {
    RenderFixture fixture(sheet(cells, 40.0f), 101, 67);
    for (const glm::vec3 target : {glm::vec3{0, 0, 0}, glm::vec3{0.2f, 0.1f, 0}}) {
      Camera camera = frontCamera();
      camera.target = target;
      const auto result = fixture.render("lucid", {}, camera);
      EXPECT_EQ(pixelsOf(result.image, once), 101u * 67) << cells;
      EXPECT_EQ(result.frame.counters.at("fragments"), 101u * 67) << cells;
    }
    // Just above the sheet and looking along it: half of its vertices are behind the eye.
    for (const float height : {0.5f, 0.02f}) {
      Camera camera = frontCamera();
      camera.eye = {0.3f, -0.2f, height};
      camera.target = {0.4f, 1.0f, height};
      camera.up = {0, 0, 1};
      const auto result = fixture.render("lucid", {}, camera);
      const std::uint64_t covered = pixelsOf(result.image, once);
      EXPECT_EQ(result.frame.counters.at("fragments"), covered) << cells;
      EXPECT_EQ(covered + pixelsOf(result.image, backgroundColor.r), 101u * 67) << cells;
      // What the lowest rays would meet is nearer than the near plane.
      const double share = std::min(1.0, double(height / camera.near));
      EXPECT_NEAR(double(covered), share * 101 * 33.5, 101 * 2) << cells;
    }
  }
}

// The worst that one can plant. `reference` rasterizes by hardware, so that a pixel at an edge may
// differ; the fragments are as many but for these.
void expectReference(const Scene& scene, std::uint32_t width, std::uint32_t height,
                     double edgeShare = 0.001) {
  SCOPED_TRACE(scene.name);
  RenderFixture fixture(scene, width, height);
  const auto exact = fixture.render("reference");
  const auto ours = fixture.render("lucid");
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < exact.image.rgba.size(); i += 4)
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(exact.image.rgba[i + c] - ours.image.rgba[i + c]) <= 2.0f / 255)) {
        ++different;
        break;
      }
  const auto fragments = double(exact.frame.counters.at("fragments"));
  EXPECT_LE(double(different), std::ceil(edgeShare * width * height));
  EXPECT_NEAR(double(ours.frame.counters.at("fragments")), fragments, 1e-3 * fragments);
  EXPECT_EQ(fixture.render("lucid", {{"depth_filter", "1"}}).hash, ours.hash);
  EXPECT_EQ(RenderFixture(scene, width, height, 5).render("lucid").hash, ours.hash);
}

TEST_F(Lucid, FansThatCutThroughEachOther) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < 60; ++i) {
    const float angle = 0.05f * float(i), c = std::cos(angle), s = std::sin(angle);
    triangles.push_back({glm::vec3{-c, -1, -s}, {c, -1, s}, {c, 1, s}});
    triangles.push_back({glm::vec3{-c, -1, -s}, {c, 1, s}, {-c, 1, -s}});
    colors.emplace_back(float(i % 7) / 6, float(i % 5) / 4, float(i % 3) / 2, 0.1f);
    colors.push_back(colors.back());
  }
  expectReference(triangleScene(triangles, colors, frontCamera()), 64, 64, 0.02);
}

// More layers than any list in shared memory holds, all at one depth.
TEST_F(Lucid, ThousandsOfCoplanarLayers) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < 4000; ++i) {
    triangles.push_back({glm::vec3{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}});
    colors.emplace_back(float(i % 7) / 6, float(i % 11) / 10, float(i % 13) / 12, 0.01f);
  }
  expectReference(triangleScene(triangles, colors, frontCamera()), 9, 5);
}

// Between the limit of high_raster and that of the repair, with a cloud that is out of order.
TEST_F(Lucid, ListsOfEveryLength) {
  Pcg32 random(7);
  for (const int count : {255, 257, 1500, 2047, 2100}) {
    std::vector<std::array<glm::vec3, 3>> triangles;
    std::vector<glm::vec4> colors;
    for (int i = 0; i < count; ++i) {
      const float z = random.uniform(-1.0f, 0.0f), tilt = random.uniform(-0.3f, 0.3f);
      triangles.push_back({glm::vec3{-9, -9, z - tilt}, {9, -9, z + tilt}, {0, 9, z}});
      colors.emplace_back(random.uniform(), random.uniform(), random.uniform(), 0.02f);
    }
    expectReference(triangleScene(triangles, colors, frontCamera()), 8, 4, 0.05);
  }
}

TEST_F(Lucid, HundredsOfThousandsOfTrianglesInOneBin) {
  Pcg32 random(3);
  std::vector<std::array<glm::vec3, 3>> triangles;
  for (int i = 0; i < 300000; ++i) {
    const glm::vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0));
    triangles.push_back({p, p + glm::vec3(0.03f, 0, 0), p + glm::vec3(0, 0.03f, 0.01f)});
  }
  expectReference(triangleScene(triangles, {{0.9f, 0.2f, 0.1f, 0.01f}, {0.1f, 0.3f, 0.8f, 0.02f}},
                                frontCamera()),
                  24, 24, 0.01);
}

TEST_F(Lucid, AScreenWideTriangleBeforeAHairball) {
  Scene scene = loadScene({"hairball", {}, 0.02f});
  const Camera camera = findView(scene, "default");
  const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::vec3 up = glm::cross(right, forward);
  const glm::vec3 center = camera.eye + 0.5f * glm::length(camera.target - camera.eye) * forward;
  const auto first = std::uint32_t(scene.vertices.size());
  for (const glm::vec2 place : {glm::vec2{-99, -99}, {99, -99}, {0, 99}})
    scene.vertices.push_back({center + place.x * right + place.y * up,
                              packNormal({0, 0, 1}),
                              {0, 0},
                              packColor({0.5f, 0.9f, 0.5f, 0.3f}),
                              0});
  scene.triangles.emplace_back(first, first + 1, first + 2);
  computeBounds(scene);
  scene.views["default"] = camera;
  expectReference(scene, 160, 90, 0.01);
}

TEST_F(Lucid, SliversAndDust) {
  Pcg32 random(11);
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0));
    if (i % 2 == 0) {  // two pixels wide at one end
      const glm::vec3 along(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      triangles.push_back({p, p + along, p + along + glm::vec3(0.02f, 0.02f, 0)});
    } else {
      triangles.push_back({p, p + glm::vec3(0.004f, 0, 0), p + glm::vec3(0, 0.004f, 0)});
    }
    colors.emplace_back(random.uniform(), random.uniform(), random.uniform(), 0.3f);
  }
  expectReference(triangleScene(triangles, colors, frontCamera()), 128, 128, 0.03);
}

TEST_F(Lucid, AlphaThresholdChangesNoPixelByMoreThanItLeavesOut) {
  for (const Scene& scene : disorderly()) {
    RenderFixture fixture(scene, 160, 90);
    const auto exact = fixture.render("lucid");
    for (const double threshold : {0.9, 1.0 - 1.0 / 128}) {
      const auto cut = fixture.render("lucid", {{"alpha_threshold", std::to_string(threshold)}});
      EXPECT_LE(compareImages(cut.image, exact.image).maxError, 1.0 - threshold + 1e-5)
          << scene.name;
    }
  }
}

// Nothing is read that the frame has not written.
TEST_F(Lucid, RubbishInItsBuffersDoesNotShow) {
  for (const Scene& scene : disorderly()) {
    RenderFixture fixture(scene, 160, 90);
    EXPECT_EQ(fixture.render("lucid", {{"poison", "on"}}).hash, fixture.render("lucid").hash)
        << scene.name;
  }
}

TEST_F(Lucid, OpaqueGeometryHidesWhatIsBehindIt) {
  OITLAB_NEEDS_SHARED_SCENES();
  const auto path = sharedScenes() / "flight_helmet.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP();
  expectTruth(lucid, loadScene({path.string(), {}, 1.0f}), 160, 120);
}

TEST_F(Lucid, AnySizeAndFormat) {
  const Scene scene = loadScene({"boxes", {}, 0.1f});
  for (const auto& [width, height] : {std::pair(1u, 1u), {7u, 3u}, {33u, 65u}, {1000u, 31u}}) {
    // Against the CPU: at this size a single pixel in doubt would decide a comparison of images.
    const CpuImage truth = renderOnCpu(scene, findView(scene, "default"), int(width), int(height));
    RenderFixture fixture(scene, width, height);
    EXPECT_EQ(judge(fixture.render("lucid").image, truth, tolerance).wrong, 0u)
        << width << "x" << height;
  }
  for (const TargetFormat format : {TargetFormat::rgba8, TargetFormat::rgba16f}) {
    RenderFixture fixture(scene, 64, 48, {}, format);
    EXPECT_LT(
        compareImages(fixture.render("lucid").image, fixture.render("reference").image).maxError,
        2.0 / 255)
        << formatName(format);
  }
}

TEST_F(Lucid, AnEmptyViewIsTheBackground) {
  const Scene scene = loadScene({"boxes", {}, 0.1f});
  RenderFixture fixture(scene, 70, 40);
  Camera away = findView(scene, "default");
  away.target = away.eye + (away.eye - away.target);
  const auto result = fixture.render("lucid", {}, away);
  EXPECT_EQ(pixelsOf(result.image, backgroundColor.r), 70u * 40);
  EXPECT_EQ(result.frame.counters.at("visible_quads"), 0u);
  EXPECT_EQ(result.frame.counters.at("fragments"), 0u);
}

TEST_F(Lucid, CountsWhatThePaperCounts) {
  const Scene scene = loadScene({"boxes", {}, 0.1f});
  RenderFixture fixture(scene, 320, 180);
  const auto all = fixture.render("lucid").frame.counters;
  const auto reference = fixture.render("reference").frame.counters;
  EXPECT_EQ(all.at("input_quads"), scene.triangles.size() / 2);
  EXPECT_EQ(all.at("small_quads") + all.at("large_quads"), all.at("visible_quads"));
  EXPECT_EQ(all.at("bins_empty") + all.at("bins_low") + all.at("bins_high"), 10u * 6);
  EXPECT_NEAR(double(all.at("fragments")), double(reference.at("fragments")), 20);
  // A tri-half-block has 1 to 32 samples.
  EXPECT_LE(all.at("half_blocks"), all.at("fragments"));
  EXPECT_GE(32 * all.at("half_blocks"), all.at("fragments"));
  const auto culled = fixture.render("lucid", {{"backface_culling", "on"}}).frame.counters;
  EXPECT_EQ(culled.at("culled_backface_quads") + culled.at("visible_quads"),
            all.at("visible_quads"));
  // Of a closed box as many faces look away as towards the eye, more or less.
  EXPECT_NEAR(double(culled.at("fragments")), 0.5 * double(all.at("fragments")),
              0.1 * double(all.at("fragments")));
}

}  // namespace
}  // namespace oitlab::testing
