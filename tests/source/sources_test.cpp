// The fragment sources against each other, against lucid, and against the CPU renderer.
#include "support/sources.h"
#include "support/planted.h"

#include <gmock/gmock.h>

#include "quality/compare.h"
#include "source/compute_types.h"
#include "support/environment.h"
#include "util/error.h"

namespace oitlab::testing {
namespace {

class Sources : public GpuTest {};

// No tolerance: both take the same fragments, order them by the same depths, and blend alike.
TEST_F(Sources, ReferenceFromComputeIsLucidBitForBit) {
  for (const Scene& scene : variedScenes()) {
    RenderFixture fixture(scene, 157, 91);
    const auto exact = fixture.render("reference", onCompute());
    const auto lucid = fixture.render("lucid");
    EXPECT_EQ(exact.hash, lucid.hash)
        << scene.name << ": " << pixelsThatDiffer(exact.image, lucid.image) << " pixels";
    EXPECT_EQ(exact.frame.counters.at("fragments"), lucid.frame.counters.at("fragments"));
  }
}

TEST_F(Sources, EveryExactMethodFromComputeIsTheReference) {
  const std::vector<std::pair<std::string, Given>> exact = {
      {"reference", {{"deliver", "shuffled"}, {"deliver_seed", "7"}}},
      {"depth_peeling", {}},
      {"depth_peeling", {{"mode", "dual"}}},
      {"depth_peeling", {{"atomics", "int32"}}},
      {"abuffer", {}},
      {"abuffer", {{"mask", "lists"}}},
      {"abuffer", {{"sort", "register"}}}};
  for (const std::string name : {"boxes", "scrubpine", "teapot"}) {
    const Scene scene = loadScene({name, {}, 0.2f});
    RenderFixture fixture(scene, 97, 61), shuffled(scene, 97, 61, 4);
    const std::string hash = fixture.render("reference", onCompute()).hash;
    EXPECT_EQ(shuffled.render("reference", onCompute()).hash, hash) << name;
    for (const auto& [method, given] : exact)
      EXPECT_EQ(fixture.render(method, onCompute(given)).hash, hash)
          << name << ": " << method << " " << ::testing::PrintToString(given);
  }
}

TEST_F(Sources, HardwareAndComputeDifferOnlyAtEdges) {
  for (const Scene& scene : variedScenes()) {
    RenderFixture fixture(scene, 160, 90);
    const CpuImage truth = renderOnCpu(scene, findView(scene, "default"), 160, 90);
    for (const std::string method : {"reference", "wboit"})
      expectEqualButAtEdges(fixture.render(method), fixture.render(method, onCompute()), truth,
                            scene.name + " " + method);
  }
}

// A blending unit in software: in the order of submission, and rounded after each step.
TEST_F(Sources, BlendFromComputeIsThatOfHardware) {
  for (const TargetFormat format :
       {TargetFormat::rgba32f, TargetFormat::rgba16f, TargetFormat::rgba8})
    for (const std::string order : {"submission", "sorted"}) {
      const Scene scene = loadScene({"planes", {}, 1.0f});
      RenderFixture fixture(scene, 160, 90, 3, format);
      const auto hardware = fixture.render("blend", {{"order", order}});
      const auto compute = fixture.render("blend", onCompute({{"order", order}}));
      // One step of the target's format for each of the layers, which may round to either side.
      const float step = format == TargetFormat::rgba32f   ? 1e-5f
                         : format == TargetFormat::rgba16f ? 40.0f / 2048
                                                           : 40.0f / 255;
      EXPECT_EQ(compute.frame.counters.at("fragments"), hardware.frame.counters.at("fragments"));
      double worst = 0;
      for (std::uint32_t y = 0; y < 90; ++y)
        for (std::uint32_t x = 0; x < 160; ++x)
          for (int c = 0; c < 3; ++c)
            worst = std::max<double>(
                worst, std::abs(hardware.image.at(x, y)[c] - compute.image.at(x, y)[c]));
      EXPECT_LE(worst, step) << order << " " << formatName(format);
      RecordProperty(fmt::format("{} {}", order, formatName(format)), fmt::format("{}", worst));
    }
}

// Lists of every kind, and long ones of several runs, in every order of delivery. Blending in
// float32 from back to front is near the exact image; the other orders are reproducible.
TEST_F(Sources, ListsOfEveryLengthAreInOrder) {
  std::set<std::uint32_t> lengths = {1, 2, 2 * SORTED_RUN + 5, 5 * SORTED_RUN + 1};
  for (const std::uint32_t limit : {SHORT_LIST, MEDIUM_LIST, SORTED_RUN, 2 * SORTED_RUN})
    for (const int more : {-1, 0, 1}) lengths.insert(std::uint32_t(int(limit) + more));
  for (const std::uint32_t length : lengths) {
    const Scene scene = stack(int(length), 0.01f);  // from front to back
    RenderFixture fixture(scene, 9, 5), shuffled(scene, 9, 5, 8);
    const auto exact = fixture.render("reference", onCompute());
    for (RenderFixture* one : {&fixture, &shuffled}) {
      const auto blended = one->render("blend", onCompute({{"deliver", "far_to_near"}}));
      EXPECT_LT(compareImages(blended.image, exact.image).maxError, 1e-3) << length;
      const auto sorted = one->render("blend", onCompute({{"order", "sorted"}}));
      EXPECT_EQ(sorted.hash, blended.hash) << length;
    }
    const auto submitted = fixture.render("blend", onCompute());
    EXPECT_EQ(submitted.hash, fixture.render("blend", onCompute({{"deliver", "near_to_far"}})).hash)
        << length;
    EXPECT_EQ(submitted.frame.counters.at("longest_list"), length > MEDIUM_LIST ? length : 0u);
  }
}

TEST_F(Sources, DeliveryIsReproducible) {
  const Scene scene = loadScene({"boxes", {}, 1.0f});
  RenderFixture plain(scene, 120, 70), shuffled(scene, 120, 70, 5);
  std::set<std::string> hashes;
  for (const Given& given :
       {Given{{"deliver", "near_to_far"}}, Given{{"deliver", "far_to_near"}},
        Given{{"deliver", "shuffled"}}, Given{{"deliver", "shuffled"}, {"deliver_seed", "1"}}}) {
    const std::string hash = plain.render("blend", onCompute(given)).hash;
    EXPECT_EQ(plain.render("blend", onCompute(given)).hash, hash);
    EXPECT_EQ(shuffled.render("blend", onCompute(given)).hash, hash);
    hashes.insert(hash);
  }
  hashes.insert(plain.render("blend", onCompute()).hash);
  EXPECT_EQ(hashes.size(), 5u) << "each order has an image of its own";
}

// What a frame reads, it has written: buffers are filled with rubbish before each frame.
TEST_F(Sources, FramesDependOnNothingOld) {
  for (const std::string name : {"boxes", "scrubpine"}) {
    RenderFixture fixture(loadScene({name, {}, 0.3f}), 130, 70);
    for (const auto& [method, given] :
         {std::pair<std::string, Given>{"reference", {}}, {"blend", {}}, {"wboit", {}}}) {
      const auto usual = fixture.render(method, onCompute(given));
      const ScopedEnvironment poison("OITLAB_POISON", "1");
      const auto poisoned = fixture.render(method, onCompute(given));
      // The sums of wboit round differently from frame to frame: its fragments come in any order.
      if (method == "wboit")
        EXPECT_LT(compareImages(poisoned.image, usual.image).maxError, 1e-5);
      else
        EXPECT_EQ(poisoned.hash, usual.hash) << name << " " << method;
    }
  }
}

TEST_F(Sources, SmallTargetsAndEmptyScenes) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {33u, 2u}, {8u, 65u}}) {
    RenderFixture fixture(randomSoup(9, 60), width, height);
    EXPECT_EQ(fixture.render("reference", onCompute()).hash, fixture.render("lucid").hash);
  }
  RenderFixture nothing(triangleScene({}, {{1, 1, 1, 1}}, frontCamera()), 20, 10);
  for (const std::string method : {"reference", "blend", "wboit", "abuffer", "depth_peeling"})
    EXPECT_EQ(nothing.render(method, onCompute()).hash, nothing.render(method).hash) << method;
}

TEST_F(Sources, ContradictoryParametersAreRefusedInOneLine) {
  RenderFixture fixture(randomSoup(1, 5), 8, 8);
  const auto message = [&](const std::string& method, const Given& given) {
    try {
      fixture.make(method, given);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(message("blend", {{"deliver", "shuffled"}}), ::testing::HasSubstr("source=compute"));
  EXPECT_THAT(message("abuffer", onCompute({{"mask", "stencil_increment"}})),
              ::testing::HasSubstr("mask=stencil_increment"));
  EXPECT_THAT(message("blend", {{"source", "compote"}}), ::testing::HasSubstr("compute"));
}

}  // namespace
}  // namespace oitlab::testing
