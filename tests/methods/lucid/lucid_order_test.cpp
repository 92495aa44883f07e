// LucidRaster with repair gives one image, bit for bit, for every depth filter, order of submission
// and run. Without repair it notices every wrong pixel. Also tests the other parameters.
#include "quality/compare.h"
#include "support/planted.h"
#include "support/truth.h"

namespace oitlab::testing {
namespace {

class LucidOrder : public GpuTest {};

TEST_F(LucidOrder, IsOneImageForEveryFilterShuffleAndRun) {
  std::vector<Scene> scenes = disorderlyScenes();
  scenes.push_back(loadScene({"boxes", {}, 0.02f}));
  for (const Scene& scene : scenes) {
    RenderFixture fixture(scene, 128, 72);
    const auto first = fixture.render("lucid");
    EXPECT_EQ(fixture.render("lucid").hash, first.hash) << scene.name << ", rendered again";
    for (const char* filter : {"1", "2", "8", "16"})
      EXPECT_EQ(fixture.render("lucid", {{"depth_filter", filter}}).hash, first.hash)
          << scene.name << ", depth filter " << filter;
    // It does not matter for the image which programs process a pixel, and each program has pixels.
    const auto on = fixture.render("lucid");
    const auto off = fixture.render("lucid", {{"ordered_first", "off"}});
    EXPECT_EQ(on.hash, first.hash) << scene.name;
    EXPECT_EQ(off.hash, first.hash) << scene.name;
    EXPECT_GT(on.frame.counters.at("filter_jobs"), 0u) << scene.name;
    EXPECT_LT(on.frame.counters.at("filter_jobs"), off.frame.counters.at("filter_jobs"))
        << scene.name;
    EXPECT_EQ(on.frame.counters.at("fragments"), off.frame.counters.at("fragments")) << scene.name;
    EXPECT_EQ(RenderFixture(scene, 128, 72, 3).render("lucid", {{"ordered_first", "off"}}).hash,
              first.hash)
        << scene.name;
    for (const std::uint64_t seed : {1, 2})
      EXPECT_EQ(RenderFixture(scene, 128, 72, seed).render("lucid").hash, first.hash)
          << scene.name << ", shuffled with seed " << seed;
  }
}

// The sort may leave tri-half-blocks of equal depth in any order, so that other pixels may be wrong
// in another frame. Therefore counters are compared with the image of the same frame.
TEST_F(LucidOrder, WrongPixelsFallAsTheFilterGrowsAndTheRepairMendsThemAll) {
  std::vector<Scene> scenes = disorderlyScenes();
  scenes.push_back(fans());
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    RenderFixture fixture(scene, 128, 72);
    const Image exact = fixture.render("lucid").image;
    std::uint64_t first = 0, before = ~0ull;
    for (const char* filter : {"1", "3", "8", "16"}) {
      const auto rough = fixture.render("lucid", {{"depth_filter", filter}, {"repair", "off"}});
      const std::uint64_t invalid = rough.frame.counters.at("invalid_pixels");
      EXPECT_EQ(rough.frame.counters.at("repaired_pixels"), 0u);
      EXPECT_LE(invalid, before) << filter;
      EXPECT_LE(pixelsThatDiffer(rough.image, exact), invalid) << filter;
      if (before == ~0ull) {
        first = invalid;
        EXPECT_GT(pixelsThatDiffer(rough.image, exact), 100u) << "nothing was wrong to begin with";
      }
      before = invalid;
      const auto mended = fixture.render("lucid", {{"depth_filter", filter}});
      EXPECT_EQ(pixelsThatDiffer(mended.image, exact), 0u) << filter;
      EXPECT_EQ(mended.frame.counters.at("repaired_pixels"),
                mended.frame.counters.at("invalid_pixels"))
          << filter;
    }
    EXPECT_LT(before, first / 2);
  }
}

TEST_F(LucidOrder, ShowsEveryWrongPixelInRed) {
  for (const Scene& scene : disorderlyScenes())
    for (const char* filter : {"1", "3"}) {
      SCOPED_TRACE(scene.name + ", depth filter " + filter);
      RenderFixture fixture(scene, 128, 72);
      const Image exact = fixture.render("lucid").image;
      const auto shown =
          fixture.render("lucid", {{"depth_filter", filter}, {"visualize_errors", "on"}});
      constexpr std::array red = {1.0f, 0.0f, 0.0f, 1.0f};
      std::uint64_t reds = 0, differ = 0;
      for (std::size_t i = 0; i < exact.rgba.size(); i += 4) {
        const float* pixel = &shown.image.rgba[i];
        if (std::equal(red.begin(), red.end(), pixel))
          ++reds;
        else
          differ += !std::equal(pixel, pixel + 4, &exact.rgba[i]);
      }
      EXPECT_EQ(differ, 0u) << "wrong, and not red";
      EXPECT_EQ(reds, shown.frame.counters.at("invalid_pixels"));
      EXPECT_EQ(shown.frame.counters.at("repaired_pixels"), 0u);
      if (*filter == '1') {
        EXPECT_GT(reds, 100u);
      }
    }
}

/// With a threshold of 1 - 1/128, blending front to back leaves out at most 1/128 of what is
/// behind.
constexpr const char* paperThreshold = "0.9921875";

// Five layers of alpha 128/255 cover 1 - (127/255)^5 = 0.969, four 0.938: with a threshold of 0.95
// the sixth layer is not blended.
TEST_F(LucidOrder, AlphaThresholdStopsAtTheLayerThatReachesIt) {
  RenderFixture fixture(stack(40, 0.5f), 70, 40);
  RenderFixture five(stack(5, 0.5f), 70, 40), six(stack(6, 0.5f), 70, 40);
  const Image cut = fixture.render("lucid", {{"alpha_threshold", "0.95"}}).image;
  EXPECT_EQ(pixelsThatDiffer(cut, five.render("lucid").image), 0u);
  EXPECT_EQ(pixelsThatDiffer(cut, six.render("lucid").image), 70u * 40);
  const Image whole = fixture.render("lucid").image;
  EXPECT_EQ(pixelsThatDiffer(cut, whole), 70u * 40);
  EXPECT_LE(compareImages(cut, whole).maxError, 0.05);
  // Three layers do not reach it, so nothing changes.
  RenderFixture three(stack(3, 0.5f), 70, 40);
  EXPECT_EQ(three.render("lucid", {{"alpha_threshold", "0.95"}}).hash, three.render("lucid").hash);
}

TEST_F(LucidOrder, AlphaThresholdIsOneImageNearTheWholeOne) {
  for (const Scene& scene : disorderlyScenes()) {
    SCOPED_TRACE(scene.name);
    RenderFixture fixture(scene, 128, 72);
    const Image whole = fixture.render("lucid").image;
    for (const std::string threshold : {"0.9", paperThreshold}) {
      const std::pair<const std::string, std::string> set = {"alpha_threshold", threshold};
      const auto cut = fixture.render("lucid", {set});
      EXPECT_LE(compareImages(cut.image, whole).maxError, 1 - std::stod(threshold) + 1e-5);
      EXPECT_GT(pixelsThatDiffer(cut.image, whole), 50u) << "it had no effect";
      EXPECT_EQ(fixture.render("lucid", {set}).hash, cut.hash) << "rendered again";
      EXPECT_EQ(fixture.render("lucid", {set, {"ordered_first", "off"}}).hash, cut.hash);
      EXPECT_EQ(fixture.render("lucid", {set, {"depth_filter", "1"}}).hash, cut.hash)
          << "another depth filter";
      EXPECT_EQ(RenderFixture(scene, 128, 72, 3).render("lucid", {set}).hash, cut.hash)
          << "shuffled";
    }
  }
}

struct View {
  Scene scene;
  Camera camera;
  std::uint32_t width = 80, height = 45;
};

/// Views that together use all buffers: vertices behind the eye, opaque geometry, deep pixels, and
/// lists that are too long for shared memory.
std::vector<View> viewsThatUseEveryBuffer() {
  std::vector<View> views;
  for (const Scene& scene : disorderlyScenes())
    views.push_back({scene, findView(scene, "default")});
  Scene opaque = randomSoup(8, 200);
  makeOpaque(opaque, 196);
  opaque.name = "soup with opaque triangles";
  views.push_back({opaque, frontCamera()});
  Camera inside = frontCamera();
  inside.eye = {0.1f, 0.0f, -0.2f};
  inside.target = {0.3f, 0.1f, -1.0f};
  views.push_back({randomSoup(5, 200), inside});
  views.push_back({layers(2500, 1.0f, 0.3f, 0.02f), frontCamera(), 10, 6});
  return views;
}

// A frame reads nothing that it has not written.
TEST_F(LucidOrder, RubbishInItsBuffersDoesNotShow) {
  std::map<std::string, std::uint64_t> used;
  for (const auto& [scene, camera, width, height] : viewsThatUseEveryBuffer()) {
    RenderFixture fixture(scene, width, height);
    for (const char* filter : {"1", "3"}) {
      const auto clean = fixture.render("lucid", {{"depth_filter", filter}}, camera);
      const auto poisoned =
          fixture.render("lucid", {{"depth_filter", filter}, {"poison", "on"}}, camera);
      EXPECT_EQ(poisoned.hash, clean.hash) << scene.name << ", depth filter " << filter;
      EXPECT_EQ(poisoned.frame.counters.at("fragments"), clean.frame.counters.at("fragments"));
      for (const char* name : {"unsnapped_triangles", "long_lists", "repaired_pixels"})
        used[name] += clean.frame.counters.at(name);
      used["deep fragments"] += clean.memory.contains("method: deep fragments");
    }
  }
  for (const auto& [name, count] : used) EXPECT_GT(count, 0u) << name << ": none in any scene";
}

}  // namespace
}  // namespace oitlab::testing
