// The A-buffer is exact with every sort, mask and memory setting, and counts what it may lose.
#include <gmock/gmock.h>

#include "abuffer/options.h"
#include "quality/compare.h"
#include "support/gpu.h"
#include "util/error.h"

namespace oitlab::testing {
namespace {

using Settings = std::map<std::string, std::string>;
using ::testing::HasSubstr;

class Abuffer : public GpuTest {};

const std::vector<std::string> sorts = {"auto",  "insertion", "merge",
                                        "shell", "bitonic",   "register"};
const std::vector<std::string> masks = {"stencil", "lists", "stencil_increment"};
const std::vector<std::string> memories = {"bma", "max", "max_by_interval"};

std::string nameOf(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += name + "=" + value + " ";
  return text;
}

/// Expects no differing pixel, in a frame as it is timed and in one with separated stages, and the
/// right number of fragments.
void expectExact(RenderFixture& fixture, const RenderFixture::Result& exact,
                 const Settings& settings) {
  SCOPED_TRACE(nameOf(settings));
  const MethodInfo& info = findMethod("abuffer");
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

/// One column of pixels for each of `depths`, with that number of layers in a pseudo-random order.
/// Every fourth layer has the depth of the one before it, and each has its own colour. In the view
/// a pixel is one unit, and the view is `rows` high.
Scene columns(const std::vector<int>& depths, int rows) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  const float half = 0.5f * float(depths.size());
  for (std::size_t column = 0; column < depths.size(); ++column)
    for (int layer = 0; layer < depths[column]; ++layer) {
      const int place = (layer * 7919) % depths[column];  // a permutation: 7919 is prime
      // The depths are so close that perspective does not move a column into the next.
      const float z = -1e-5f * float(place % 4 == 3 ? place - 1 : place);
      const float left = 2.0f * (float(column) - half) / float(rows);
      const float right = left + 2.0f / float(rows), high = 2.0f, low = -2.0f;
      triangles.push_back({glm::vec3{left, low, z}, {right, low, z}, {right, high, z}});
      triangles.push_back({glm::vec3{left, low, z}, {right, high, z}, {left, high, z}});
      const glm::vec4 color{float(layer % 7) / 6, float(layer % 11) / 10, float(layer % 13) / 12,
                            0.02f + 0.02f * float(layer % 5)};
      colors.push_back(color);
      colors.push_back(color);
    }
  return triangleScene(triangles, colors, frontCamera());
}

RenderFixture columnFixture(const std::vector<int>& depths, int rows = 2) {
  return RenderFixture(columns(depths, rows), std::uint32_t(depths.size()), std::uint32_t(rows));
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
TEST_F(Abuffer, ColoursAreHeldAsAskedFor) {
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

TEST_F(Abuffer, GrowsAndLosesNothing) {
  RenderFixture fixture = columnFixture({30, 40, 50}, 8);
  const auto roomy = fixture.render("abuffer", {{"initial_depth", "64"}});
  const auto tight = fixture.render("abuffer", {{"initial_depth", "0"}});
  EXPECT_EQ(roomy.frame.recordings, 1);
  EXPECT_EQ(tight.frame.recordings, 2);
  EXPECT_EQ(tight.hash, roomy.hash);
  EXPECT_EQ(tight.frame.counters, roomy.frame.counters);
}

TEST_F(Abuffer, DropsWhatMemoryDoesNotHoldAndCountsIt) {
  constexpr unsigned pixels = 3 * 8, fragments = 8 * (30 + 40 + 50);
  RenderFixture fixture = columnFixture({30, 40, 50}, 8);
  for (const std::string& mask : masks)
    for (const std::string& memory : memories) {
      const Settings settings = {{"on_overflow", "drop"},
                                 {"initial_depth", "10"},
                                 {"mask", mask},
                                 {"sort_memory", memory},
                                 {"max_fragments", "16"}};
      const auto result = fixture.render("abuffer", settings);
      EXPECT_EQ(result.frame.counters.at("fragments"), fragments);
      EXPECT_EQ(result.frame.counters.at("blended_fragments"), 10 * pixels + 1) << nameOf(settings);
      EXPECT_EQ(result.frame.counters.at("lost_fragments"), fragments - 10 * pixels - 1);
    }
}

TEST_F(Abuffer, TruncatesAsThePaperDoesAndCountsIt) {
  RenderFixture fixture = columnFixture({10, 16, 17, 40, 300}, 2);
  for (const std::string& mask : masks)
    for (const std::string& memory : memories)
      for (const char* sort : {"auto", "register"}) {
        const Settings settings = {{"deep", "truncate"},
                                   {"max_fragments", "16"},
                                   {"mask", mask},
                                   {"sort_memory", memory},
                                   {"sort", sort}};
        const auto counters = fixture.render("abuffer", settings).frame.counters;
        EXPECT_EQ(counters.at("truncated_pixels"), 2u * 3) << nameOf(settings);
        EXPECT_EQ(counters.at("truncated_fragments"), 2u * (1 + 24 + 284)) << nameOf(settings);
        EXPECT_EQ(counters.at("blended_fragments"), 2u * (10 + 4 * 16)) << nameOf(settings);
      }
}

TEST_F(Abuffer, EachIntervalIsAStage) {
  RenderFixture fixture = columnFixture({10, 40});
  const auto stagesOf = [&](const Settings& settings) {
    std::vector<std::string> sortsRun;
    for (const auto& [name, ms] : fixture.render("abuffer", settings).frame.stageMs)
      if (name.rfind("sort", 0) == 0) sortsRun.push_back(name);
    return sortsRun;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(stagesOf({{"max_fragments", "32"}}), ElementsAre("sort 8", "sort 16", "sort 32"));
  EXPECT_THAT(stagesOf({{"sort_memory", "max_by_interval"}, {"max_fragments", "20"}}),
              ElementsAre("sort 8", "sort 16", "sort 20"));
  EXPECT_THAT(stagesOf({{"sort_memory", "max"}}), ElementsAre("sort"));
}

TEST_F(Abuffer, OnlyTheMaskInUseTakesMemory) {
  RenderFixture fixture(randomSoup(1, 8), 64, 32);
  const MethodInfo& info = findMethod("abuffer");
  const auto buffersOf = [&](const Settings& settings) {
    const auto method =
        fixture.renderer().make(info, Parameters(info.parameters, settings, info.name));
    return method->memory().byName();
  };
  const auto bma = buffersOf({{"initial_depth", "2"}});
  EXPECT_EQ(bma.at("fragment nodes"), (2u * 64 * 32 + 1) * 28);
  EXPECT_EQ(bma.at("fragment counts"), 64u * 32 * 4);
  EXPECT_GE(bma.at("stencil"), 64u * 32);
  EXPECT_EQ(buffersOf({{"mask", "lists"}}).at("pixel lists"), 64u * 32 * 4);
  EXPECT_EQ(buffersOf({{"mask", "stencil_increment"}}).count("fragment counts"), 0u);
  const auto max = buffersOf({{"sort_memory", "max"}});
  EXPECT_EQ(max.count("fragment counts"), 0u);
  EXPECT_EQ(max.count("stencil"), 0u);
  EXPECT_EQ(buffersOf({{"node_color", "rgba8"}, {"initial_depth", "0"}}).at("fragment nodes"), 16u);
}

/// A camera that sees nothing.
Camera away() {
  Camera camera = frontCamera();
  camera.eye = {0, 0, 5};
  camera.target = {0, 0, 6};
  return camera;
}

// The experiment of figure 3 draws nothing, for every length of its array up to the 8 KiB of the
// experiment.
TEST_F(Abuffer, LocalMemoryLeavesTheImageAsItWas) {
  RenderFixture fixture(randomSoup(1, 8), 33, 9);
  const std::string background = fixture.render("reference", {}, away()).hash;
  for (const char* size : {"1", "64", "512"}) {
    const auto result = fixture.render("local_memory", {{"size", size}, {"passes", "3"}}, away());
    EXPECT_EQ(result.hash, background) << size;
    EXPECT_EQ(result.frame.stageMs.back().first, "fill");
  }
}

// Drivers may refuse longer arrays: NVIDIA's 580.159.04 does so at 16 KiB per invocation, with an
// error that names no shader. Then the program says which shader it was and what to change.
TEST_F(Abuffer, MuchLocalMemoryWorksOrIsRefusedWithAReason) {
  RenderFixture fixture(randomSoup(1, 8), 33, 9);
  const std::string background = fixture.render("reference", {}, away()).hash;
  const std::string exact = fixture.render("reference").hash;
  std::vector<std::string> refusals;
  const auto refusedOr = [&](const std::string& hash, const std::string& method,
                             const Settings& settings, const Camera& camera,
                             std::vector<std::string> said) {
    try {
      EXPECT_EQ(fixture.render(method, settings, camera).hash, hash) << nameOf(settings);
    } catch (const DeviceError& error) {
      for (const std::string& part : said) EXPECT_THAT(error.what(), HasSubstr(part));
      refusals.emplace_back(error.what());
    }
  };
  refusedOr(background, "local_memory", {{"size", "1024"}, {"passes", "3"}}, away(),
            {"local_memory.frag", "SIZE=1024", "16384 bytes", "lower 'size'"});
  // There is one pipeline per interval of lengths, and the refused one need not be the longest.
  refusedOr(exact, "abuffer", {{"local", "fragments"}, {"max_fragments", "1024"}},
            fixture.defaultView(),
            {"abuffer/resolve.frag", "MAX_FRAGMENTS=", " bytes of local memory",
             "lower 'max_fragments' (now 1024)", "local=keys"});
  if (!refusals.empty() && !HasFailure())
    GTEST_SKIP() << fmt::format("{}", fmt::join(refusals, "\n"));
}

TEST(AbufferOptions, TellHowMuchLocalMemoryAnInvocationTakes) {
  const auto bytesOf = [](const Settings& settings) {
    const auto declared = abuffer::declareParameters();
    const abuffer::Options options(Parameters(declared, settings, "abuffer"), DeviceInfo{},
                                   "rgba32f");
    return options.intervals.back().localBytes;
  };
  EXPECT_EQ(bytesOf({{"sort", "insertion"}, {"max_fragments", "64"}}), 64u * 8);
  EXPECT_EQ(bytesOf({{"sort", "merge"}, {"max_fragments", "64"}}), (64u + 32) * 8);
  EXPECT_EQ(bytesOf({{"sort", "bitonic"}, {"max_fragments", "100"}}), 128u * 8);
  EXPECT_EQ(bytesOf({{"sort", "register"}, {"max_fragments", "512"}}), 16u * 8);
  EXPECT_EQ(bytesOf({{"max_fragments", "8"}}), 8u * 8);
  EXPECT_EQ(bytesOf({{"max_fragments", "8"}, {"sort_memory", "max"}}), 8u * 8);
  EXPECT_EQ(bytesOf({{"sort_memory", "max"}}), (512u + 256) * 8);
  EXPECT_EQ(bytesOf({{"local", "fragments"}}), (512u + 256) * 24);
  EXPECT_EQ(bytesOf({{"local", "fragments"}, {"node_color", "rgba8"}}), (512u + 256) * 12);
}

TEST(PipelineRefusal, NamesShadersDefinesCauseAndRemedy) {
  EXPECT_EQ(pipelineRefusal("GPU", {"a.vert", "b.frag"}, {{"N", "9"}, {"SORT", "1"}}, {},
                            "ErrorUnknown", "lower 'n'"),
            "GPU makes no pipeline of shaders/a.vert and shaders/b.frag (N=9, SORT=1): "
            "ErrorUnknown; lower 'n'");
  EXPECT_EQ(pipelineRefusal("GPU", {"c.comp"}, {}, {7, 8}, "ErrorUnknown", ""),
            "GPU makes no pipeline of shaders/c.comp (constant 0=7, constant 1=8): ErrorUnknown");
}

}  // namespace
}  // namespace oitlab::testing
