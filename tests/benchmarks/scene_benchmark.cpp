// Time for a scene before the first frame, on one core unless noted. All of it should be linear, so
// the throughput must not fall with size.
#include <benchmark/benchmark.h>
#include <cstdlib>

#include "scene/atlas.h"
#include "scene/quads.h"
#include "util/random.h"

namespace oitlab {
namespace {

/// `cells` x `cells` cells of two triangles. With `shuffled` they are in random order, the worst
/// case for caches.
Scene grid(std::uint32_t cells, bool shuffled) {
  Scene scene;
  scene.name = "grid";
  scene.materials.resize(1);
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x)
      scene.vertices.push_back({{float(x), float(y), 0.0f}, 0, {0, 0}, ~0u, 0});
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, d = a + cells + 1;
      scene.triangles.emplace_back(a, a + 1, d + 1);
      scene.triangles.emplace_back(a, d + 1, d);
    }
  Pcg32 random(1);
  for (std::size_t i = scene.triangles.size(); shuffled && i > 1; --i)
    std::swap(scene.triangles[i - 1], scene.triangles[random.next() % i]);
  return scene;
}

void pairQuads(benchmark::State& state, bool shuffled) {
  const Scene scene = grid(std::uint32_t(state.range(0)), shuffled);
  for (auto _ : state) benchmark::DoNotOptimize(pairTriangles(scene).quads.data());
  state.SetItemsProcessed(state.iterations() * std::int64_t(scene.triangles.size()));
  state.SetLabel("triangles");
  state.counters["triangles"] = double(scene.triangles.size());
}
// 20K, 180K and 1M triangles.
BENCHMARK_CAPTURE(pairQuads, in_order, false)
    ->Arg(100)
    ->Arg(300)
    ->Arg(707)
    ->Unit(benchmark::millisecond);
BENCHMARK_CAPTURE(pairQuads, shuffled, true)
    ->Arg(100)
    ->Arg(300)
    ->Arg(707)
    ->Unit(benchmark::millisecond);

/// Makes generated scenes at full detail, with bounds and views.
void load(benchmark::State& state, const char* name) {
  std::size_t triangles = 0;
  for (auto _ : state) triangles = loadScene({name, {}, 1.0f}).triangles.size();
  state.SetItemsProcessed(state.iterations() * std::int64_t(triangles));
  state.SetLabel("triangles");
}
/// Loads a file of the user: OITLAB_SCENE=path.glb.
void loadFile(benchmark::State& state) {
  const char* path = std::getenv("OITLAB_SCENE");
  if (path == nullptr) return state.SkipWithError("OITLAB_SCENE names no file");
  load(state, path);
}

BENCHMARK(loadFile)->Unit(benchmark::millisecond);
BENCHMARK_CAPTURE(load, boxes, "boxes")->Unit(benchmark::millisecond);
BENCHMARK_CAPTURE(load, teapot, "teapot")->Unit(benchmark::millisecond);

/// Builds the atlases of two noise textures with alpha, on all cores.
void atlas(benchmark::State& state) {
  Scene scene;
  Pcg32 random(1);
  for (int i = 0; i < 2; ++i) {
    Texture texture{.name = "noise", .width = int(state.range(0)), .height = int(state.range(0))};
    texture.rgba.resize(std::size_t(texture.width) * std::size_t(texture.height) * 4);
    for (std::uint8_t& byte : texture.rgba) byte = std::uint8_t(random.next());
    scene.textures.push_back(texture);
    scene.materials.push_back({.texture = i, .alphaMode = AlphaMode::blend});
  }
  for (auto _ : state) benchmark::DoNotOptimize(buildAtlases(scene).transparent.width);
  state.SetItemsProcessed(state.iterations() * 2 * state.range(0) * state.range(0));
  state.SetLabel("texels");
}
BENCHMARK(atlas)->Arg(128)->Arg(512)->UseRealTime()->Unit(benchmark::millisecond);

}  // namespace
}  // namespace oitlab

BENCHMARK_MAIN();
