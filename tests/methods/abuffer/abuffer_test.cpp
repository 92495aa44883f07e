// The A-buffer is exact with every sort, mask and memory setting.
#include <gmock/gmock.h>

#include "quality/compare.h"
#include "support/columns.h"

namespace oitlab::testing {
namespace {

/// Expects no differing pixel, in a frame as it is timed and in one with separated stages, and the
/// right number of fragments.
void expectExact(RenderFixture& fixture, const RenderFixture::Result& exact,
                 const Settings& settings) {
  SCOPED_TRACE(nameOf(settings));
  const MethodInfo info = findMethod("abuffer");
  Renderer& renderer = fixture.renderer();
  const auto method = renderer.make(info, Parameters(info.parameters, settings, info.name));
  FrameResult frame;
  for (const bool instrumented : {false, true}) {
    frame = renderer.render(*method, fixture.defaultView(), instrumented);
    EXPECT_EQ(imageHash(renderer.target().readBytes(sharedDevice())), exact.hash)
        << (instrumented ? "stages apart" : "as timed");
  }
  for (const char* counter : {"fragments", "max_fragments_per_pixel", "covered_pixels"})
    EXPECT_EQ(frame.counters.at(counter), exact.frame.counters.at(counter)) << counter;
  EXPECT_EQ(frame.counters.at("blended_fragments"), exact.frame.counters.at("fragments"));
}

const std::vector<int> aroundEveryBound = {1,   2,   7,   8,   9,   15,  16,  17,
                                           31,  32,  33,  63,  64,  65,  100, 127,
                                           128, 129, 253, 254, 255, 256, 257, 300};

// Equal depths, every choice of sort, mask and memory, and pixels below and above max_fragments.
TEST_F(Abuffer, EveryChoiceIsExactOnRandomTriangles) {
  RenderFixture fixture(randomSoup(21, 160), 40, 32);
  const auto exact = fixture.render("reference");
  ASSERT_GT(exact.frame.counters.at("max_fragments_per_pixel"), 32u);
  for (const std::string& memory : memories)
    for (const std::string& mask : masks)
      for (const std::string& sort : sorts)
        expectExact(
            fixture, exact,
            {{"sort_memory", memory}, {"mask", mask}, {"sort", sort}, {"max_fragments", "24"}});
}

TEST_F(Abuffer, IsExactOnOtherRandomTrianglesToo) {
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    RenderFixture fixture(randomSoup(seed, 40 + 8 * int(seed % 16)), 24, 24);
    const auto exact = fixture.render("reference");
    expectExact(
        fixture, exact,
        {{"mask", masks[seed % 3]}, {"sort", sorts[seed % 5 + 1]}, {"max_fragments", "16"}});
  }
}

TEST_F(Abuffer, EveryIntervalIsExactUpToItsBounds) {
  RenderFixture fixture = columnFixture(aroundEveryBound);
  const auto exact = fixture.render("reference");
  ASSERT_EQ(exact.frame.counters.at("covered_pixels"), 2 * aroundEveryBound.size());
  for (const std::string& sort : sorts)
    expectExact(fixture, exact, {{"sort", sort}, {"mask", "lists"}, {"max_fragments", "512"}});
  for (const std::string& mask : masks)
    for (const char* most : {"8", "16", "64", "200", "255", "256", "512", "1024"})
      expectExact(fixture, exact, {{"mask", mask}, {"max_fragments", most}});
}

TEST_F(Abuffer, CountsThePixelsOfEachInterval) {
  RenderFixture fixture = columnFixture({3, 8, 9, 16, 17, 40, 65, 128, 129, 257, 300}, 2);
  const Settings all[] = {{{"mask", "stencil"}},
                          {{"mask", "lists"}},
                          {{"mask", "stencil_increment"}},
                          {{"sort_memory", "max"}},
                          {{"max_fragments", "32"}}};
  for (const Settings& settings : all) {
    const auto counters = fixture.render("abuffer", settings).frame.counters;
    const std::pair<const char*, unsigned> expected[] = {
        {"pixels_8", 4},   {"pixels_16", 4},   {"pixels_32", 2},
        {"pixels_64", 2},  {"pixels_128", 4},  {"pixels_256", 2},
        {"pixels_512", 4}, {"pixels_1024", 0}, {"pixels_more", 0}};
    for (const auto& [name, pixels] : expected)
      EXPECT_EQ(counters.at(name), pixels) << name << " " << nameOf(settings);
  }
}

// A stencil saturates at 255 and cannot tell larger counts apart.
TEST_F(Abuffer, PixelsBeyondTheStencilsRangeAreDeep) {
  RenderFixture fixture = columnFixture({253, 254, 255, 256, 700}, 2);
  const auto exact = fixture.render("reference");
  for (const char* most : {"256", "1024"}) {
    const Settings settings = {{"mask", "stencil_increment"}, {"max_fragments", most}};
    expectExact(fixture, exact, settings);
    EXPECT_EQ(fixture.render("abuffer", settings).frame.counters.at("deep_pixels"), 6u);
  }
  EXPECT_EQ(fixture.render("abuffer", {{"max_fragments", "1024"}}).frame.counters.at("deep_pixels"),
            0u);
}

// The stencil also counts fragments that the alpha cutoff discards: its count may be larger than
// the list, but never smaller.
TEST_F(Abuffer, FragmentsThatAlphaCutsOffAreOnlyCountedByTheStencil) {
  Scene scene = columns({20, 300}, 2);
  scene.materials[0].alphaCutoff = 0.05f;  // alphas are from 0.02 to 0.10
  RenderFixture fixture(scene, 2, 2);
  const auto exact = fixture.render("reference");
  ASSERT_LT(exact.frame.counters.at("fragments"), 2u * 320);
  for (const std::string& mask : masks) expectExact(fixture, exact, {{"mask", mask}});
}

// A thousand layers from back to front are the worst case of insertion sort.
TEST_F(Abuffer, SortsAThousandLayersInAnyOrder) {
  for (const bool backToFront : {true, false}) {
    std::vector<std::array<glm::vec3, 3>> layers;
    std::vector<glm::vec4> colors;
    for (int i = 0; i < 1024; ++i) {
      const float z = -0.001f * float(backToFront ? 1024 - i : i);
      layers.push_back({glm::vec3{0, -99, z}, {0, 99, z}, {-99, 0, z}});
      colors.emplace_back(float(i % 7) / 6, float(i % 11) / 10, float(i % 13) / 12, 0.01f);
    }
    RenderFixture fixture(triangleScene(layers, colors, frontCamera()), 4, 2);
    const auto exact = fixture.render("reference");
    ASSERT_EQ(exact.frame.counters.at("max_fragments_per_pixel"), 1024u);
    for (const std::string& sort : sorts)
      expectExact(fixture, exact,
                  {{"sort", sort}, {"max_fragments", "1024"}, {"sort_memory", "max"}});
  }
}

// Pixels that need more than one round of the sort in their lists, beside deep pixels that need
// only the first, and pixels of a single layer.
TEST_F(Abuffer, HasNoLimitOfLayers) {
  RenderFixture fixture = columnFixture({1, 3000, 8, 300});
  const auto exact = fixture.render("reference");
  for (const std::string& memory : memories)
    for (const std::string& mask : masks)
      expectExact(fixture, exact,
                  {{"sort_memory", memory}, {"mask", mask}, {"max_fragments", "64"}});
}

TEST_F(Abuffer, EveryBuiltInSceneIsExact) {
  for (const SceneInfo& info : sceneCatalogue()) {
    RenderFixture fixture(loadScene({info.name, {}, 0.004f}), 96, 54);
    const auto exact = fixture.render("reference");
    const Settings all[] = {{{"max_fragments", "64"}},
                            {{"sort_memory", "max"}, {"max_fragments", "64"}},
                            {{"mask", "lists"}, {"max_fragments", "16"}},
                            {{"mask", "stencil_increment"}, {"max_fragments", "16"}}};
    for (const Settings& settings : all) {
      SCOPED_TRACE(info.name);
      expectExact(fixture, exact, settings);
    }
  }
}

TEST_F(Abuffer, IsTheSameUnderShuffledSubmissionAndFromRunToRun) {
  const Scene soup = randomSoup(31, 120);
  RenderFixture plain(soup, 48, 48);
  const std::string exact = plain.render("reference").hash;
  for (const std::string& mask : masks) {
    const Settings settings = {{"mask", mask}, {"max_fragments", "16"}};
    for (int run = 0; run < 3; ++run)
      EXPECT_EQ(plain.render("abuffer", settings).hash, exact) << mask;
    for (const std::uint64_t seed : {1, 2, 3})
      EXPECT_EQ(RenderFixture(soup, 48, 48, seed).render("abuffer", settings).hash, exact)
          << mask << ", shuffled with seed " << seed;
  }
}

// A counting stencil is tested against a copy of the opaque depth. The copy must be equal bit for
// bit, because fragments at exactly the depth of an opaque surface are kept.
TEST_F(Abuffer, FragmentsAreTestedAgainstOpaqueDepth) {
  Scene scene = columns({40, 41}, 8);
  Material opaque;
  scene.materials.push_back(opaque);
  const float z = -1e-5f * 20.0f;  // the depth of a layer
  const auto first = std::uint32_t(scene.vertices.size());
  for (const glm::vec3& corner : {glm::vec3{-9, -1, z}, glm::vec3{9, -1, z}, glm::vec3{0, 0.5f, z}})
    scene.vertices.push_back({corner, packNormal({0.0f, 0.0f, 1.0f}), {}, 0xffffffffu, 1});
  scene.triangles.emplace_back(first, first + 1, first + 2);
  RenderFixture fixture(scene, 2, 8);
  const auto exact = fixture.render("reference");
  const std::uint64_t fragments = exact.frame.counters.at("fragments");
  ASSERT_GT(fragments, 8u * (40 + 41) / 2);
  ASSERT_LT(fragments, 8u * (40 + 41) - 4 * 40);
  for (const std::string& mask : masks) expectExact(fixture, exact, {{"mask", mask}});
}

TEST_F(Abuffer, EveryTargetFormatIsThatOfTheReference) {
  for (const TargetFormat format : {TargetFormat::rgba16f, TargetFormat::rgba8}) {
    RenderFixture fixture(loadScene({"boxes", {}, 0.1f}), 80, 45, {}, format);
    const auto exact = fixture.render("reference");
    for (const std::string& memory : memories)
      expectExact(fixture, exact, {{"sort_memory", memory}, {"max_fragments", "8"}});
  }
}

// Colours in lists may be stored with less precision. The format in local memory changes nothing.
TEST_F(Abuffer, ColorsAreHeldAsAskedFor) {
  RenderFixture fixture = columnFixture({1, 9, 40, 100});
  const auto exact = fixture.render("reference");
  for (const char* local : {"keys", "fragments"}) {
    // 256 fragments of 24 bytes, and half as much for merging: 9 KiB per invocation.
    expectExact(fixture, exact, {{"local", local}, {"max_fragments", "256"}});
    for (const auto& [color, error] : {std::pair{"rgba16f", 1e-3}, std::pair{"rgba8", 1.0 / 128}}) {
      const auto result = fixture.render(
          "abuffer", {{"local", local}, {"node_color", color}, {"max_fragments", "64"}});
      const double found = compareImages(result.image, exact.image).maxError;
      EXPECT_GT(found, 0.0) << color;
      EXPECT_LT(found, error) << color;
    }
  }
}

}  // namespace
}  // namespace oitlab::testing
