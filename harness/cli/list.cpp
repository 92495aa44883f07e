#include "cli/commands.h"
#include "method/method.h"
#include "results/describe.h"
#include "scene/scene.h"
#include "util/error.h"
#include "util/json_file.h"
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
  if (asJson) fmt::print("{}\n", jsonText(nlohmann::json{{"methods", list}}));
  return exitDone;
}

int listScenes(bool asJson) {
  nlohmann::json list = nlohmann::json::array();
  for (const SceneInfo& info : sceneCatalogue()) {
    const SceneSize size = generatedSize(info.name);
    list.push_back(
        {{"name", info.name},
         {"summary", info.summary},
         {"triangles", size.triangles},
         {"quads", size.quads},
         {"degenerate_percent", 100.0 * double(size.degenerateQuads) / double(size.quads)},
         {"vertices", size.vertices},
         {"materials", size.materials},
         {"textures", size.textures},
         {"views", size.views},
         {"paths", size.paths}});
    if (!asJson)
      fmt::print("{:<12} {:>9} triangles   {}\n", info.name, size.triangles, info.summary);
  }
  if (asJson)
    fmt::print("{}\n", jsonText(nlohmann::json{{"scenes", list}}));
  else
    fmt::print("and any .glb, .gltf or .obj file, by its path\n");
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
