#include "scene/generate/generators.h"

#include <algorithm>
#include <cmath>

#include "scene/views.h"
#include "util/error.h"

namespace oitlab {

std::span<const GeneratedScene* const> generatedScenes() {
#define OITLAB_ADDRESS(name) &generated::name,
  static constexpr const GeneratedScene* allScenes[] = {OITLAB_GENERATED_SCENES(OITLAB_ADDRESS)};
#undef OITLAB_ADDRESS
  return allScenes;
}

const GeneratedScene* findGenerated(const std::string& name) {
  for (const GeneratedScene* scene : generatedScenes())
    if (scene->name == name) return scene;
  return nullptr;
}

std::vector<SceneInfo> sceneCatalogue() {
  std::vector<SceneInfo> catalogue;
  for (const GeneratedScene* scene : generatedScenes())
    catalogue.push_back({scene->name, scene->summary});
  return catalogue;
}

/// The result of pairTriangles() for each scene at full detail. The scenes are deterministic, so
/// these are constants, and `oitlab list scenes` need not make 12.7 million triangles. A test
/// compares them with the scenes. After a change of a scene, `oitlab scene NAME --json` prints the
/// new numbers.
struct PairedQuads {
  const char* name;
  std::uint64_t quads, degenerate;
};
constexpr PairedQuads pairedQuads[] = {
    {"boxes", 6000, 0},     {"bunny", 72600, 0},        {"conference", 162836, 0},
    {"dragon", 435172, 0},  {"gallery", 511698, 25968}, {"hairball", 1440000, 0},
    {"planes", 32, 0},      {"powerplant", 6379229, 0}, {"sanmiguel", 3096729, 575848},
    {"scrubpine", 290, 52}, {"smoke", 6734, 0},         {"sponza_like", 130488, 0},
    {"teapot", 8192, 128},  {"whiteoak", 19442, 1870},
};

SceneSize generatedSize(const std::string& name, float detail) {
  const GeneratedScene* generated = findGenerated(name);
  if (!generated) fail<InputError>("scene '{}' is not a generated one", name);
  MeshBuilder builder(name, MeshBuilder::Mode::count);
  generated->build(builder, detail);
  SceneSize size{.triangles = builder.triangleCount(), .vertices = builder.vertexCount()};
  Scene scene = builder.take();
  size.materials = scene.materials.size();
  size.textures = scene.textures.size();
  scene.views.try_emplace("default");
  addNamedViews(scene, {});
  if (detail == 1.0f)
    for (const PairedQuads& paired : pairedQuads)
      if (name == paired.name) size.quads = paired.quads, size.degenerateQuads = paired.degenerate;
  for (const auto& [view, camera] : scene.views) size.views.push_back(view);
  for (const auto& [path, cameras] : scene.paths) size.paths.push_back(path);
  return size;
}

int scaledCount(float count, float fineness, int least) {
  return std::max(least, int(std::lround(count * fineness)));
}

void buildToCount(MeshBuilder& builder, double triangles,
                  void (*structure)(MeshBuilder& builder, float fineness)) {
  const auto countAt = [&](double logFineness) {
    MeshBuilder trial(builder.name(), MeshBuilder::Mode::count);
    structure(trial, float(std::exp(logFineness)));
    return std::pair(trial.triangleCount(), trial.vertexCount());
  };
  // A coarse structure has few possible counts: take the nearer one.
  double low = std::log(1e-3), high = std::log(1e3);
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (double(countAt(middle).first) < triangles ? low : high) = middle;
  }
  const auto [below, ignored] = countAt(low);
  const auto [above, ignoredToo] = countAt(high);
  const double fineness = triangles - double(below) < double(above) - triangles ? low : high;
  const auto [count, vertices] = countAt(fineness);
  builder.reserve(builder.vertexCount() + vertices, builder.triangleCount() + count);
  structure(builder, float(std::exp(fineness)));
}

}  // namespace oitlab
