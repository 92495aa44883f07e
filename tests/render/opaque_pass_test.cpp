// Transparent triangles that lie on opaque copies of themselves: equal depth is kept, whoever
// rasterizes.
#include "render/opaque_pass.h"

#include <fmt/format.h>

#include "render/depth_complexity.h"
#include "support/planted.h"
#include "support/sources.h"
#include "util/random.h"

namespace oitlab::testing {
namespace {

class OpaquePassGpu : public GpuTest {};

using Corners = std::array<glm::vec3, 3>;

/// The order of a transparent copy's corners.
enum class Order { same, reversed, rotated };

Corners reordered(const Corners& t, Order order) {
  if (order == Order::reversed) return {t[2], t[1], t[0]};
  if (order == Order::rotated) return {t[1], t[2], t[0]};
  return t;
}

/// Each triangle once transparent, then once opaque.
Scene onOpaqueCopies(const std::vector<Corners>& triangles, Order order) {
  std::vector<Corners> all;
  std::vector<glm::vec4> colors;
  Pcg32 random(3);
  for (const Corners& t : triangles) {
    all.push_back(reordered(t, order));
    colors.emplace_back(random.uniform(), random.uniform(), random.uniform(), 0.6f);
  }
  for (const Corners& t : triangles) {
    all.push_back(t);
    colors.emplace_back(random.uniform(), random.uniform(), random.uniform(), 1.0f);
  }
  Scene scene = triangleScene(all, colors, frontCamera());
  makeOpaque(scene, triangles.size());
  return scene;
}

std::vector<Corners> soupCorners(std::uint64_t seed, int count) {
  const Scene soup = randomSoup(seed, count);
  std::vector<Corners> triangles;
  for (const glm::uvec3& t : soup.triangles)
    triangles.push_back(
        {soup.vertices[t.x].position, soup.vertices[t.y].position, soup.vertices[t.z].position});
  return triangles;
}

struct Case {
  std::string name;
  std::vector<Corners> triangles;
};

std::vector<Case> cases() {
  const glm::vec3 a{-0.8f, -0.6f, 0.1f}, b{0.7f, -0.7f, -0.5f}, c{0.5f, 0.8f, -0.9f},
      d{-0.9f, 0.6f, -0.2f};
  return {{"triangle", {{a, b, c}}},
          {"flat quad", {{a, b, c}, {a, c, a + c - b}}},
          {"bent quad", {{a, b, c}, {a, c, d}}},
          {"soup", soupCorners(31, 200)}};
}

/// Views in which no corner is nearer than the near plane.
std::vector<Camera> cameras() {
  std::vector<Camera> views(4, frontCamera());
  views[1].eye = {1.9f, 0.7f, 1.6f};
  views[2].eye = {-2.5f, 0.1f, 0.8f};
  views[2].target = {0.1f, 0.1f, -0.3f};
  views[3].eye = {0.3f, -3.1f, 0.4f};
  views[3].up = {0, 0, 1};
  return views;
}

/// Compares with the CPU renderer in the pixels where that has no doubt.
class Judge {
 public:
  Judge(const std::vector<Corners>& triangles, const Camera& camera, int width, int height)
      : truth_(renderOnCpu(onOpaqueCopies(triangles, Order::same), camera, width, height)) {}

  const CpuImage& truth() const { return truth_; }

  /// Fragments per pixel.
  void expectCounts(const std::vector<std::uint32_t>& counts) const {
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < counts.size(); ++i)
      wrong += truth_.doubts[i] == 0 && counts[i] != truth_.fragments[i];
    EXPECT_EQ(wrong, 0u);
  }

  /// An image of an exact method, and how many fragments it has blended.
  void expectImage(const RenderFixture::Result& result) const {
    EXPECT_EQ(judge(result.image, truth_, tolerance, true).wrong, 0u);
    expectTotal(result);
  }

  /// Fragments in pixels in doubt may be one more or less for each layer that is seen there.
  void expectTotal(const RenderFixture::Result& result) const {
    std::uint64_t inDoubt = 0;
    for (std::size_t i = 0; i < truth_.doubts.size(); ++i)
      if (truth_.doubts[i] != 0) inDoubt += 1 + truth_.fragments[i];
    EXPECT_NEAR(double(result.frame.counters.at("fragments")), double(truth_.fragmentCount()),
                double(inDoubt));
  }

 private:
  CpuImage truth_;
};

// Bit-equal depths, also where triangles are seen almost from the edge and their planes are steep.
TEST_F(OpaquePassGpu, FragmentsOnAnOpaqueCopyAreKept) {
  std::uint64_t covered = 0, inDoubt = 0;
  for (const auto& [width, height] : {std::pair{200, 120}, {157, 91}})
    for (const Case& one : cases())
      for (const Camera& camera : cameras()) {
        const Judge truth(one.triangles, camera, width, height);
        covered += truth.truth().coveredPixels();
        inDoubt += truth.truth().pixelsInDoubt(0xff);
        for (const Order order : {Order::same, Order::reversed, Order::rotated}) {
          SCOPED_TRACE(fmt::format("{}x{} {} from {},{},{}, order {}", width, height, one.name,
                                   camera.eye.x, camera.eye.y, camera.eye.z, int(order)));
          RenderFixture fixture(onOpaqueCopies(one.triangles, order), std::uint32_t(width),
                                std::uint32_t(height));
          // Hardware interpolates the depth of a copy with another order of corners in its own way.
          if (order == Order::same) {
            truth.expectCounts(countFragments(fixture.renderer(), camera).counts);
            truth.expectImage(fixture.render("reference", {}, camera));
          }
          truth.expectCounts(countFragments(fixture.renderer(), camera, false).counts);
          const auto lucid = fixture.render("lucid", {}, camera);
          truth.expectImage(lucid);
          const auto reference = fixture.render("reference", onCompute(), camera);
          EXPECT_EQ(reference.hash, lucid.hash);
          truth.expectTotal(reference);
          truth.expectTotal(fixture.render("blend", onCompute(), camera));
        }
      }
  // Nearly all pixels must be without doubt, or nothing was tested.
  EXPECT_LT(double(inDoubt), 0.02 * double(covered));
  EXPECT_GT(covered, 50'000u);
}

}  // namespace
}  // namespace oitlab::testing
