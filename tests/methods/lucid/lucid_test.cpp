// LucidRaster gives the CPU renderer's image, is watertight, and has the right counters.
#include "raster/raster_types.h"
#include "scene/quads.h"
#include "support/planted.h"
#include "support/shared_scenes.h"
#include "support/truth.h"

namespace oitlab::testing {
namespace {

constexpr int segmentTriangles = SEGMENT_TRIANGLES;
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
  std::vector<std::string> missing;
  for (const std::string name : {"sponza.glb", "oaktree.glb", "alpha_blend_mode_test.glb"}) {
    const auto path = sharedScenes() / name;
    if (std::filesystem::exists(path))
      expectTruth(lucid, loadScene({path.string(), 0.5f, 1.0f}), 160, 120);
    else
      missing.push_back(name);
  }
  if (!missing.empty())
    GTEST_SKIP() << "not in ../shared/scenes: " << fmt::to_string(fmt::join(missing, ", "));
}

// Watertight: below the horizon each pixel has one layer, above it none. There are edges in front
// of and behind the eye, and vertices on samples.
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
      // The lowest rays would hit the sheet in front of the near plane.
      const double share = std::min(1.0, double(height / camera.near));
      EXPECT_NEAR(double(covered), share * 101 * 33.5, 101 * 2) << cells;
    }
  }
}

TEST_F(Lucid, OpaqueFileAgreesWithTheCpu) {
  OITLAB_NEEDS_SHARED_SCENES();
  const auto path = sharedScenes() / "flight_helmet.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  expectTruth(lucid, loadScene({path.string(), {}, 1.0f}), 160, 120);
}

/// `soup` with an opaque rectangle from x = -reach at z = `front` to x = reach at z = `back`. Its
/// triangles come after all others.
Scene withOpaqueWall(Scene soup, float reach, float front, float back) {
  const std::size_t transparent = soup.triangles.size();
  const auto first = std::uint32_t(soup.vertices.size());
  for (const glm::vec3 place : {glm::vec3{-reach, -reach, front},
                                {reach, -reach, back},
                                {reach, reach, back},
                                {-reach, reach, front}})
    soup.vertices.push_back(
        {place, packNormal({0, 0, 1}), {0, 0}, packColor({0.2f, 0.7f, 0.4f, 1}), 0});
  soup.triangles.emplace_back(first, first + 1, first + 2);
  soup.triangles.emplace_back(first, first + 2, first + 3);
  makeOpaque(soup, transparent);
  computeBounds(soup);
  return soup;
}

// A wall that intersects the triangles: half of the fragments are hidden, others in each pixel.
TEST_F(Lucid, OpaqueGeometryHidesWhatIsBehindIt) {
  for (const std::uint64_t seed : {41, 42}) {
    const Scene soup = randomSoup(seed, 300);
    const Scene walled = withOpaqueWall(soup, 0.9f, 0.3f, -0.8f);
    expectTruth(lucid, walled, 96, 96);
    RenderFixture fixture(walled, 96, 96);
    const auto ours = fixture.render("lucid");
    const auto fragments = ours.frame.counters.at("fragments");
    const auto all = RenderFixture(soup, 96, 96).render("lucid").frame.counters.at("fragments");
    EXPECT_LT(double(fragments), 0.9 * double(all));
    EXPECT_GT(double(fragments), 0.3 * double(all));
    for (const char* filter : {"1", "8"})
      EXPECT_EQ(fixture.render("lucid", {{"depth_filter", filter}}).hash, ours.hash) << filter;
    EXPECT_EQ(RenderFixture(walled, 96, 96, 2).render("lucid").hash, ours.hash) << "shuffled";
  }
}

TEST_F(Lucid, NothingIsSampledBehindAWall) {
  // Near the eye and over the whole frame; the soup is behind z = 0.5.
  const Scene scene = withOpaqueWall(randomSoup(43, 300), 2.0f, 0.6f, 0.6f);
  RenderFixture fixture(scene, 96, 64);
  const auto result = fixture.render("lucid");
  EXPECT_EQ(result.frame.counters.at("fragments"), 0u);
  EXPECT_EQ(result.frame.counters.at("invalid_pixels"), 0u);
  EXPECT_GT(result.frame.counters.at("half_blocks"), 0u);
  RenderFixture alone(withOpaqueWall(triangleScene({}, {}, frontCamera()), 2.0f, 0.6f, 0.6f), 96,
                      64);
  EXPECT_EQ(result.hash, alone.render("reference").hash);
}

using Counters = std::map<std::string, std::uint64_t>;

Counters countersOf(const Scene& scene, std::uint32_t width, std::uint32_t height,
                    const std::map<std::string, std::string>& parameters = {}) {
  return RenderFixture(scene, width, height).render("lucid", parameters).frame.counters;
}

// The counters of quads are those of pairTriangles(), the number of bins is that of the frame, and
// the number of samples is that of the CPU renderer.
TEST_F(Lucid, CountsWhatThePaperCounts) {
  for (const Scene& scene :
       {loadScene({"boxes", {}, 0.1f}), loadScene({"hairball", {}, 0.02f}), randomSoup(3, 200)}) {
    SCOPED_TRACE(scene.name);
    const Counters all = countersOf(scene, 150, 90);
    const QuadMesh quads = pairTriangles(scene);
    EXPECT_EQ(all.at("input_quads"), quads.quads.size());
    EXPECT_EQ(all.at("degenerate_quads"), quads.degenerate);
    EXPECT_LE(all.at("visible_quads"), all.at("input_quads"));
    EXPECT_LE(all.at("visible_degenerate_quads"), all.at("degenerate_quads"));
    EXPECT_EQ(all.at("small_quads") + all.at("large_quads"), all.at("visible_quads"));
    EXPECT_EQ(all.at("bins_empty") + all.at("bins_low") + all.at("bins_high"), 5u * 3);
    const CpuImage truth = renderOnCpu(scene, findView(scene, "default"), 150, 90);
    EXPECT_NEAR(double(all.at("fragments")), double(truth.fragmentCount()),
                double(truth.pixelsInDoubt(doubt::edge)));
    // A tri-half-block has 1 to 32 samples.
    EXPECT_LE(all.at("half_blocks"), all.at("fragments"));
    EXPECT_GE(32 * all.at("half_blocks"), all.at("fragments"));
  }
}

TEST_F(Lucid, CountsAreThoseWorkedOutByHand) {
  // Three layers over 5 x 3 bins with 20 x 23 half-blocks. Each layer is one triangle without a
  // partner and is in every bin and half-block.
  const Counters over = countersOf(stack(3, 0.5f), 160, 90);
  const Counters expected = {{"input_quads", 3},
                             {"degenerate_quads", 3},
                             {"visible_quads", 3},
                             {"visible_degenerate_quads", 3},
                             {"small_quads", 0},
                             {"large_quads", 3},
                             {"visible_triangles", 3},
                             {"bins_empty", 0},
                             {"bins_low", 15},
                             {"bins_high", 0},
                             {"bin_entries", 3 * 15},
                             {"half_blocks", 3 * 20 * 23},
                             {"fragments", 3 * 160 * 90},
                             {"long_lists", 0},
                             {"invalid_pixels", 0},
                             {"repaired_pixels", 0}};
  for (const auto& [name, value] : expected) EXPECT_EQ(over.at(name), value) << name;
  // A bin is high if it has more triangles than a part. Quads over five bins are large. A small
  // quad is counted as two triangles, even when it is degenerate.
  for (const int count : {segmentTriangles, segmentTriangles + 1}) {
    const Counters bins = countersOf(stack(count, 0.01f), 160, 16);
    EXPECT_EQ(bins.at("bins_low"), count == segmentTriangles ? 5u : 0u);
    EXPECT_EQ(bins.at("bins_high"), count == segmentTriangles ? 0u : 5u);
  }
  // One quad inside the upper left of four bins, and another one behind the eye.
  const Scene one = triangleScene({{glm::vec3{-0.9f, 0.2f, 0}, {-0.2f, 0.2f, 0}, {-0.9f, 0.9f, 0}},
                                   {glm::vec3{-1, 0, 3}, {1, 0, 3}, {0, 1, 3}}},
                                  {{1, 1, 1, 0.5f}}, frontCamera());
  const Counters corner = countersOf(one, 64, 64);
  EXPECT_EQ(corner.at("input_quads"), 2u);
  EXPECT_EQ(corner.at("visible_quads"), 1u);
  EXPECT_EQ(corner.at("small_quads"), 1u);
  EXPECT_EQ(corner.at("bins_empty"), 3u);
  EXPECT_EQ(corner.at("bin_entries"), 1u);
  EXPECT_EQ(corner.at("unsnapped_triangles"), 0u);
}

TEST_F(Lucid, CullingBackFacesDropsTheQuadsThatItCounts) {
  const Scene scene = loadScene({"boxes", {}, 0.1f});
  const Counters all = countersOf(scene, 320, 180);
  const Counters culled = countersOf(scene, 320, 180, {{"backface_culling", "on"}});
  EXPECT_EQ(culled.at("culled_backface_quads") + culled.at("visible_quads"),
            all.at("visible_quads"));
  // About half of the faces of closed boxes are back-facing.
  EXPECT_NEAR(double(culled.at("fragments")), 0.5 * double(all.at("fragments")),
              0.1 * double(all.at("fragments")));
}

}  // namespace
}  // namespace oitlab::testing
