#include "support/sources.h"

#include "support/planted.h"

namespace oitlab::testing {

Given onCompute(Given given) {
  given["source"] = "compute";
  return given;
}

std::vector<Scene> variedScenes() {
  std::vector<Scene> scenes;
  for (const auto& [name, detail] : {std::pair{"boxes", 1.0f},
                                     {"planes", 1.0f},
                                     {"teapot", 0.3f},
                                     {"scrubpine", 0.3f},
                                     {"sanmiguel", 0.003f},
                                     {"hairball", 0.005f},
                                     {"smoke", 0.5f}})
    scenes.push_back(loadScene({name, {}, detail}));
  for (const std::uint64_t seed : {1, 2, 3}) scenes.push_back(randomSoup(seed, 400));
  for (Scene& scene : disorderlyScenes()) scenes.push_back(std::move(scene));
  return scenes;
}

Differences differencesOf(const Image& a, const Image& b, const CpuImage& truth, double allowed) {
  Differences found;
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x) {
      double difference = 0;
      for (int c = 0; c < 3; ++c)
        difference = std::max<double>(difference, std::abs(a.at(x, y)[c] - b.at(x, y)[c]));
      const std::size_t i = truth.index(x, y);
      // Hardware interpolates over vertices that are snapped, which moves colours that much.
      if (difference <= allowed + double(truth.snapping[i])) continue;
      ++(truth.doubts[i] == 0 ? found.certain : found.inDoubt);
    }
  return found;
}

void expectEqualButAtEdges(const RenderFixture::Result& hardware,
                           const RenderFixture::Result& compute, const CpuImage& truth,
                           const std::string& what) {
  const double chances =
      std::max(double(truth.width) * truth.height, double(truth.fragmentCount()));
  const Differences d = differencesOf(hardware.image, compute.image, truth, tolerance);
  EXPECT_EQ(d.certain, 0u) << what;
  EXPECT_LE(double(d.inDoubt), 0.001 * chances) << what;
  EXPECT_NEAR(double(hardware.frame.counters.at("fragments")),
              double(compute.frame.counters.at("fragments")), 0.001 * chances)
      << what;
}

}  // namespace oitlab::testing
