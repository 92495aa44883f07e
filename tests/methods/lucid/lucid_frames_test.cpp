// LucidRaster over several frames, and in frames of many sizes. After other frames, which may have
// enlarged its buffers, a method gives the same image as a new one.
#include "support/planted.h"
#include "support/truth.h"

namespace oitlab::testing {
namespace {

class LucidFrames : public GpuTest {};

/// From almost nothing to the whole scene, into its centre with vertices behind the eye, and back.
std::vector<Camera> journey(const Scene& scene) {
  const Camera full = findView(scene, "default");
  Camera away = full, aside = full, inside = full;
  away.target = away.eye + (away.eye - away.target);
  // Close to the edge of the view.
  const glm::vec3 forward = full.target - full.eye;
  const glm::vec3 right = glm::normalize(glm::cross(forward, full.up));
  aside.target = full.target + glm::length(forward) * 1.2f * right;
  inside.eye = 0.4f * full.eye + 0.6f * full.target;
  return {away, aside, full, inside, full, away, inside, aside};
}

TEST_F(LucidFrames, AMethodThatMovesOnMakesTheImagesOfFreshOnes) {
  Scene opaque = randomSoup(31, 400);
  makeOpaque(opaque, 395);
  opaque.name = "soup with opaque triangles";
  for (const Scene& scene :
       {loadScene({"whiteoak", {}, 0.02f}), loadScene({"hairball", {}, 0.02f}), opaque}) {
    SCOPED_TRACE(scene.name);
    RenderFixture fixture(scene, 100, 60);
    const auto method = fixture.make("lucid", {{"depth_filter", "1"}});
    const auto plain = fixture.make("lucid", {{"depth_filter", "1"}});
    int recordings = 0, frame = 0;
    for (const Camera& camera : journey(scene)) {
      SCOPED_TRACE(fmt::format("frame {}", frame++));
      const auto fresh = fixture.render("lucid", {{"depth_filter", "1"}}, camera);
      const auto moved = fixture.render(*method, camera);
      EXPECT_EQ(moved.hash, fresh.hash);
      for (const char* counter : {"fragments", "half_blocks", "bin_entries", "visible_quads"})
        EXPECT_EQ(moved.frame.counters.at(counter), fresh.frame.counters.at(counter)) << counter;
      // As in a measurement: without counting.
      EXPECT_EQ(fixture.render(*plain, camera, false).hash, fresh.hash);
      // Buffers stay enlarged: after the fullest views no frame is recorded twice.
      if (frame > 4) {
        EXPECT_EQ(moved.frame.recordings, 1);
      }
      recordings += moved.frame.recordings;
    }
    EXPECT_GT(recordings, frame) << "it never grew";
  }
}

// Deep pixels appear and disappear: a frame must not use the lists of the last frame.
TEST_F(LucidFrames, DeepPixelsComeAndGo) {
  RenderFixture fixture(layers(2500, 1.0f, 0.3f, 0.02f), 10, 6);
  const auto method = fixture.make("lucid");
  Camera away = fixture.defaultView();
  away.target.z = 2.0f;
  const auto full = fixture.render(*method, fixture.defaultView());
  EXPECT_GT(full.frame.recordings, 1);
  EXPECT_EQ(full.frame.counters.at("fragments"), 2500u * 10 * 6);
  for (int turn = 0; turn < 2; ++turn) {
    const auto empty = fixture.render(*method, away);
    EXPECT_EQ(pixelsOf(empty.image, backgroundColor.r), 10u * 6);
    EXPECT_EQ(empty.frame.counters.at("fragments"), 0u);
    const auto again = fixture.render(*method, fixture.defaultView(), turn == 0);
    EXPECT_EQ(again.hash, full.hash);
    EXPECT_EQ(again.frame.recordings, 1);
  }
}

TEST_F(LucidFrames, AnySize) {
  const Scene scene = randomSoup(17, 60);
  for (const auto& [width, height] : {std::pair(1, 1),
                                      {7, 3},
                                      {31, 33},
                                      {32, 32},
                                      {33, 31},
                                      {64, 4},
                                      {33, 65},
                                      {1000, 31},
                                      {3000, 5},
                                      {5, 700}}) {
    const CpuImage truth = renderOnCpu(scene, findView(scene, "default"), width, height);
    RenderFixture fixture(scene, std::uint32_t(width), std::uint32_t(height));
    const auto ours = fixture.render("lucid");
    const Verdict verdict = judge(ours.image, truth, tolerance);
    SCOPED_TRACE(fmt::format("{} x {}", width, height));
    EXPECT_EQ(verdict.wrong, 0u);
    // Allows for a pixel at an edge; a single one is more than 0.1% of a small frame.
    EXPECT_LE(double(verdict.edges + verdict.orders), std::ceil(0.001 * width * height));
    const auto bins = std::uint64_t((width + 31) / 32) * std::uint64_t((height + 31) / 32);
    const auto& counters = ours.frame.counters;
    EXPECT_EQ(counters.at("bins_empty") + counters.at("bins_low") + counters.at("bins_high"), bins);
    EXPECT_GT(counters.at("fragments"), 0u);
  }
}

TEST_F(LucidFrames, AnyFormat) {
  const Scene scene = randomSoup(17, 60);
  const Image exact = RenderFixture(scene, 64, 48).render("lucid").image;
  // Background and result are both rounded to the format: by half a step of 1/255, and an NVIDIA
  // H200 has 0.56 in all. Half floats have steps of 2^-11 below 1, and llvmpipe rounds towards 0.
  for (const auto& [format, error] :
       {std::pair(TargetFormat::rgba8, 1.0 / 255), {TargetFormat::rgba16f, 0x1p-10}}) {
    const Image image = RenderFixture(scene, 64, 48, {}, format).render("lucid").image;
    double worst = 0;
    for (std::size_t i = 0; i < exact.rgba.size(); ++i)
      worst = std::max(worst, double(std::abs(image.rgba[i] - exact.rgba[i])));
    EXPECT_LE(worst, error) << formatName(format);
  }
}

TEST_F(LucidFrames, AnEmptyViewIsTheBackground) {
  const Scene scene = loadScene({"boxes", {}, 0.1f});
  RenderFixture fixture(scene, 70, 40);
  Camera away = findView(scene, "default");
  away.target = away.eye + (away.eye - away.target);
  const auto result = fixture.render("lucid", {}, away);
  EXPECT_EQ(pixelsOf(result.image, backgroundColor.r), 70u * 40);
  EXPECT_EQ(result.frame.counters.at("visible_quads"), 0u);
  EXPECT_EQ(result.frame.counters.at("fragments"), 0u);
  EXPECT_EQ(result.frame.counters.at("bins_empty"), 3u * 2);
}

}  // namespace
}  // namespace oitlab::testing
