#include "cli/commands.h"
#include "experiment/describe.h"
#include "method/method.h"
#include "scene/quads.h"
#include "scene/scene.h"
#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

struct ListOptions {
  std::string what;
  bool json = false;
};

int listMethods(bool asJson) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, info] : methods()) {
    list.push_back(describeMethod(info));
    if (asJson) continue;
    fmt::print("{}{}\n  {}\n  after: {}\n", name, info.exact ? "  (exact)" : "", info.summary,
               info.source);
    for (const Parameter& p : info.parameters)
      fmt::print("  --set {}={}   {} {}\n      {}\n", p.name, toString(p.defaultValue),
                 p.typeName(), p.rangeText(), p.help);
  }
  if (asJson) fmt::print("{}\n", nlohmann::json{{"methods", list}}.dump(2));
  return exitDone;
}

int listScenes(bool asJson) {
  nlohmann::json list = nlohmann::json::array();
  for (const SceneInfo& info : sceneCatalogue()) {
    const Scene scene = loadScene({info.name, {}, 1.0f});
    const QuadMesh quads = cachedQuads(scene);
    std::vector<std::string> views;
    for (const auto& [name, camera] : scene.views) views.push_back(name);
    list.push_back({{"name", info.name},
                    {"summary", info.summary},
                    {"triangles", scene.triangles.size()},
                    {"quads", quads.quads.size()},
                    {"degenerate_percent", quads.degeneratePercent()},
                    {"vertices", scene.vertices.size()},
                    {"materials", scene.materials.size()},
                    {"textures", scene.textures.size()},
                    {"views", views}});
    if (!asJson)
      fmt::print("{:<12} {:>9} triangles   {}\n", info.name, scene.triangles.size(), info.summary);
  }
  if (asJson)
    fmt::print("{}\n", nlohmann::json{{"scenes", list}}.dump(2));
  else
    fmt::print("and any .glb or .gltf file, by its path\n");
  return exitDone;
}

}  // namespace

void addList(CLI::App& program, Action& action) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* verb = program.add_subcommand(
      "list", "Methods with their parameters (type, range, default, unit), or generated scenes");
  verb->add_option("what", options->what, "methods or scenes")->required();
  verb->add_flag("--json", options->json, "One JSON object on stdout");
  verb->callback([=, &action] {
    action = [=] {
      if (options->what == "methods") return listMethods(options->json);
      if (options->what == "scenes") return listScenes(options->json);
      fail<InputError>("cannot list '{}'{}; wanted: methods or scenes", options->what,
                       didYouMean(options->what, {"methods", "scenes"}));
    };
  });
}

}  // namespace oitlab
