// Compares the CPU renderer with values that were computed by hand.
#include "cpu_reference/cpu_renderer.h"

#include <gmock/gmock.h>

#include "support/gpu.h"

namespace oitlab::testing {
namespace {

glm::dvec4 colorAt(const CpuImage& image, int x, int y) {
  return image.color[image.index(x, y)];
}

std::array<glm::vec3, 3> layerAt(float z) {
  return {glm::vec3{-9, -9, z}, {9, -9, z}, {0, 9, z}};
}

// shade() for the normal (0, 0, 1).
constexpr double frontLight = 0.2 + 0.8 * (0.5 + 0.5 * 0.4206);

TEST(CpuReference, TwoLayersBlendAsWorkedOutByHand) {
  const glm::vec4 red{1, 0, 0, 0.5f}, green{0, 1, 0, 0.25f};
  const Scene scene = triangleScene({layerAt(0), layerAt(-1)}, {red, green}, frontCamera());
  const CpuImage image = renderOnCpu(scene, frontCamera(), 17, 11);
  const double redAlpha = 128 / 255.0, greenAlpha = 64 / 255.0;  // as stored in 8 bits
  const double transmitted = (1 - redAlpha) * (1 - greenAlpha) * double(backgroundColor.r);
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 17; ++x) {
      const glm::dvec4 color = colorAt(image, x, y);
      EXPECT_NEAR(color.r, redAlpha * frontLight + transmitted, 1e-6);
      EXPECT_NEAR(color.g, (1 - redAlpha) * greenAlpha * frontLight + transmitted, 1e-6);
      EXPECT_NEAR(color.b, transmitted, 1e-12);
      EXPECT_EQ(color.a, 1.0);
    }
  EXPECT_EQ(image.fragmentCount(), 2u * 17 * 11);
  EXPECT_EQ(image.coveredPixels(), 17u * 11);
  EXPECT_EQ(image.maxFragmentsPerPixel(), 2u);
  EXPECT_EQ(image.pixelsInDoubt(0xff), 0u);
}

TEST(CpuReference, OpaqueFragmentsHideWhatIsBehindThem) {
  Scene scene = triangleScene({layerAt(0), layerAt(-1), layerAt(-2)},
                              {{1, 0, 0, 0.5f}, {0, 1, 0, 1}, {0, 0, 1, 0.5f}}, frontCamera());
  scene.materials.push_back({});  // opaque
  for (int i = 0; i < 3; ++i) scene.vertices[scene.triangles[1][i]].material = 1;
  const CpuImage image = renderOnCpu(scene, frontCamera(), 4, 4);
  EXPECT_EQ(image.fragmentCount(), 16u);
  EXPECT_NEAR(colorAt(image, 1, 1).r, 128 / 255.0 * frontLight, 1e-6);
  EXPECT_NEAR(colorAt(image, 1, 1).g, 127 / 255.0 * frontLight, 1e-6);
  EXPECT_NEAR(colorAt(image, 1, 1).b, 0.0, 1e-12);
}

// At equal depth the opaque triangle that is submitted last wins; of transparent triangles the one
// with the lower id is in front.
TEST(CpuReference, EqualDepthsAreOrderedByPrimitiveId) {
  const glm::vec4 red{1, 0, 0, 0.5f}, green{0, 1, 0, 0.5f};
  Scene scene = triangleScene({layerAt(0), layerAt(0)}, {red, green}, frontCamera());
  CpuImage image = renderOnCpu(scene, frontCamera(), 4, 4);
  const double alpha = 128 / 255.0, rest = (1 - alpha) * (1 - alpha) * double(backgroundColor.r);
  EXPECT_NEAR(colorAt(image, 2, 2).r, alpha * frontLight + rest, 1e-6);
  EXPECT_NEAR(colorAt(image, 2, 2).g, (1 - alpha) * alpha * frontLight + rest, 1e-6);
  EXPECT_EQ(image.pixelsInDoubt(0xff), 0u) << "copies of a triangle have a sure order";
  scene.materials[0].alphaMode = AlphaMode::opaque;
  image = renderOnCpu(scene, frontCamera(), 4, 4);
  EXPECT_NEAR(colorAt(image, 2, 2).r, 0.0, 1e-12);
  EXPECT_NEAR(colorAt(image, 2, 2).g, frontLight, 1e-6);
}

TEST(CpuReference, AttributesAreInterpolatedInPerspective) {
  // A floor at y = -1 under the eye at (0, 0, 1). A pixel at screen height s (down) sees the
  // distance 1 / s, which is z = 1 - 1 / s. Red grows from 0 at z = 0 to 1 at z = -8.
  Scene scene = triangleScene({{glm::vec3{-50, -1, 0}, {50, -1, 0}, {50, -1, -8}},
                               {glm::vec3{-50, -1, 0}, {50, -1, -8}, {-50, -1, -8}}},
                              {{0, 0, 0, 1}}, frontCamera());
  for (Vertex& v : scene.vertices) v.color = packColor({v.position.z == 0.0f ? 0 : 1, 0, 0, 1});
  const CpuImage image = renderOnCpu(scene, frontCamera(), 31, 64);
  for (int y = 40; y < 64; ++y) {
    const double s = (2 * y + 1) / 64.0 - 1, z = 1 - 1 / s;
    EXPECT_NEAR(colorAt(image, 13, y).r, -z / 8 * frontLight, 1e-6) << y;
  }
}

// A transparent triangle through the near plane: it has no fragments in front of the near plane,
// and none behind the eye.
TEST(CpuReference, NearPlaneCutsFragmentsNotTriangles) {
  Camera camera = frontCamera();  // at z = 1, 90 degrees
  camera.near = 2.0f;
  // A floor at y = -1 from far behind the eye to far in front. Screen height s sees the distance 1
  // / s, so with the near plane at 2 only s < 0.5 is visible.
  const Scene scene = triangleScene({{glm::vec3{-999, -1, 99}, {999, -1, 99}, {0, -1, -999}}},
                                    {{1, 1, 1, 0.5f}}, camera);
  const CpuImage image = renderOnCpu(scene, camera, 5, 64);
  for (int y = 0; y < 64; ++y)
    EXPECT_EQ(image.fragments[image.index(2, y)], y >= 32 && y < 48 ? 1u : 0u) << y;
}

Scene sheet(int cells, float z, float tilt) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  const auto corner = [&](int x, int y) {
    const glm::vec2 at = glm::vec2(-64.0f) + 128.0f * glm::vec2(x, y) / float(cells);
    return glm::vec3(at.x, at.y, z + tilt * at.y);
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const glm::vec3 a = corner(x, y), b = corner(x + 1, y), c = corner(x + 1, y + 1),
                      d = corner(x, y + 1);
      // Both diagonals and both windings.
      if ((x + y) % 2 == 0)
        triangles.insert(triangles.end(), {{a, b, c}, {a, d, c}});
      else
        triangles.insert(triangles.end(), {{b, d, a}, {b, c, d}});
    }
  return triangleScene(triangles, {{1, 1, 1, 0.5f}}, frontCamera());
}

TEST(CpuReference, WatertightSheetCoversEveryPixelOnce) {
  // A scene unit is 32 pixels and cells have sides of 1 or 1/4, so corners and edges are on pixel
  // centres when the eye is moved by half a pixel.
  for (const int cells : {37, 128, 512})
    for (const float shift : {0.0f, 1.0f / 64, 0.3f}) {
      Camera camera = frontCamera();
      camera.eye += glm::vec3(shift, shift, 0);
      camera.target += glm::vec3(shift, shift, 0);
      const CpuImage image = renderOnCpu(sheet(cells, 0.0f, 0.0f), camera, 64, 64);
      EXPECT_THAT(image.fragments, ::testing::Each(1u)) << cells << " cells, moved by " << shift;
    }
}

TEST(CpuReference, WatertightSheetCoversEveryPixelOnceAtGrazingAngles) {
  // Slopes of 3 to 60 under the eye, which is 1 above the sheet; half of the sheet is behind the
  // eye. Above the horizon at 1 / slope there is nothing. Pixels are in doubt where float32 may
  // round to either side.
  for (const float slope : {3.0f, 10.0f, 60.0f})
    for (const int cells : {9, 64}) {
      const CpuImage image = renderOnCpu(sheet(cells, 0.0f, slope), frontCamera(), 101, 67);
      EXPECT_LE(image.maxFragmentsPerPixel(), 1u) << slope;
      // z = slope * y intersects the ray (0, -t v, 1 - t) at t = 1 / (1 - slope * v), for v down.
      for (int y = 0; y < 67; ++y) {
        const double v = (2 * y + 1) / 67.0 - 1, t = 1 / (1 - double(slope) * v);
        const bool hit = t > 0.05 && t * std::abs(v) < 64;
        EXPECT_EQ(image.fragments[image.index(50, y)], hit ? 1u : 0u) << slope << ", row " << y;
      }
    }
}

TEST(CpuReferenceDoubts, DepthsThatFloatsCannotTellApart) {
  const glm::vec4 red{1, 0, 0, 0.5f}, green{0, 1, 0, 0.5f};
  const auto doubted = [&](float behind, const glm::vec4& color) {
    const Scene scene = triangleScene({layerAt(0), layerAt(-behind)}, {red, color}, frontCamera());
    return renderOnCpu(scene, frontCamera(), 4, 4).pixelsInDoubt(doubt::depthOrder);
  };
  EXPECT_EQ(doubted(1e-6f, green), 16u);
  EXPECT_EQ(doubted(1e-4f, green), 0u);
  EXPECT_EQ(doubted(1e-6f, red), 0u) << "the order does not show";
  EXPECT_EQ(doubted(1e-6f, {0, 1, 0, 1 / 255.0f}), 0u) << "nor does this layer";
}

TEST(CpuReferenceDoubts, SurfacesThatCrossWithinThePixelGrid) {
  // One triangle is at z = 0, one at z = 4 x. They intersect in the line x = 0 between two columns.
  // Snapping its vertices moves the steep one by at most 1/256 pixel.
  const std::array<glm::vec3, 3> steep = {glm::vec3{-9, -9, -36}, {9, -9, 36}, {0, 99, 0}};
  const Scene scene =
      triangleScene({layerAt(0), steep}, {{1, 0, 0, 0.5f}, {0, 1, 0, 0.5f}}, frontCamera());
  EXPECT_EQ(renderOnCpu(scene, frontCamera(), 64, 64).pixelsInDoubt(doubt::depthOrder), 0u);
  Camera moved = frontCamera();  // moved by a little more than half a pixel: the line is 1/400
                                 // pixel from centres
  moved.eye.x = moved.target.x = (0.5f + 1 / 400.0f) / 32;
  const CpuImage image = renderOnCpu(scene, moved, 64, 64);
  EXPECT_EQ(image.pixelsInDoubt(doubt::depthOrder), 64u);
  EXPECT_NE(image.doubts[image.index(31, 5)] & doubt::depthOrder, 0);
}

TEST(CpuReferenceDoubts, EdgesCloserToACentreThanTheGrid) {
  const auto render = [](float pixels, std::optional<AlphaMode> front) {
    // A triangle with a vertical edge that is `pixels` to the right of the centre of column 32, and
    // another triangle in front of everything.
    const float edge = (0.5f + pixels) / 32;
    Scene scene = triangleScene({{glm::vec3{edge, -99, 0}, {edge, 99, 0}, {-300, 0, 0}}},
                                {{1, 1, 1, 0.5f}}, frontCamera());
    if (front) {
      scene.materials.push_back({.alphaMode = *front});
      for (const glm::vec3& p : layerAt(0.5f))
        scene.vertices.push_back({p, 0, {0, 0}, 0x80ffffffu, 1});
      scene.triangles.emplace_back(3, 4, 5);
    }
    return renderOnCpu(scene, frontCamera(), 64, 64);
  };
  for (const float pixels : {1 / 300.0f, -1 / 300.0f}) {
    const CpuImage image = render(pixels, {});
    EXPECT_EQ(image.pixelsInDoubt(doubt::edge), 64u) << pixels;
    EXPECT_EQ(image.doubts[image.index(32, 7)], doubt::edge) << pixels;
    EXPECT_EQ(image.fragments[image.index(32, 7)], pixels > 0 ? 1u : 0u);
    EXPECT_EQ(render(pixels, AlphaMode::blend).pixelsInDoubt(doubt::edge), 64u);
    EXPECT_EQ(render(pixels, AlphaMode::opaque).pixelsInDoubt(doubt::edge), 0u) << "hidden";
  }
  for (const float pixels : {1 / 200.0f, -1 / 200.0f})
    EXPECT_EQ(render(pixels, {}).pixelsInDoubt(doubt::edge), 0u) << pixels;
}

TEST(CpuReferenceDoubts, AlphaNextToTheCutoff) {
  for (const float alpha : {0.25f, 0.5f, 0.75f}) {
    Scene scene = triangleScene({layerAt(0)}, {{1, 1, 1, alpha}}, frontCamera());
    scene.materials[0].alphaCutoff = 0.5f;
    const CpuImage image = renderOnCpu(scene, frontCamera(), 4, 4);
    EXPECT_EQ(image.fragmentCount(), alpha < 0.5f ? 0u : 16u) << alpha;
    EXPECT_EQ(image.pixelsInDoubt(doubt::cutoff), alpha == 0.5f ? 16u : 0u) << alpha;
  }
}

}  // namespace
}  // namespace oitlab::testing
