#include "experiment/scene_choice.h"

#include "scene/generate/generators.h"
#include "scene/import/content_hash.h"
#include "scene/views.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

/// Names of generated scenes stay; paths are taken relative to the experiment's folder. A scene
/// that is neither is an error now, not when its turn comes after an hour of measuring.
std::string resolveSource(const TomlTable& owner, const toml::node& node, const std::string& source,
                          bool optional, const fs::path& folder) {
  std::vector<std::string> names;
  for (const SceneInfo& info : sceneCatalogue()) {
    if (info.name == source) return source;
    names.push_back(info.name);
  }
  const fs::path path(source);
  std::error_code error;
  std::string resolved =
      path.is_absolute() ? source : fs::relative(folder / path, error).generic_string();
  if (resolved.empty()) resolved = (folder / path).generic_string();
  const bool isFile = fs::is_regular_file(resolved, error);
  if (!isFile && fs::exists(resolved, error))
    owner.failAt(node,
                 fmt::format("scene '{}' is not a file; wanted: .glb, .gltf or .obj", source));
  if (!isFile && !optional)
    owner.failAt(node, fmt::format("scene '{}' is neither a generated one ({}) nor a file{}",
                                   source, joinNames(names), didYouMean(source, names)));
  return resolved;
}

/// Of a file and all that it names; "" of a generated scene.
std::string contentHashOf(const SceneSpec& spec) {
  if (findGenerated(spec.source)) return "";
  return sceneContentHash(spec.source, spec.allowOutside).value_or("");
}

/// A scene without geometry, with the views and paths that can be known without loading it.
Scene knownViews(const SceneSpec& spec) {
  const GeneratedScene* generated = findGenerated(spec.source);
  if (generated == nullptr) {
    Scene scene;
    scene.name = fs::path(spec.source).stem().string();
    scene.views.try_emplace("default");
    addNamedViews(scene, spec.source);
    return scene;
  }
  constexpr float coarse = 1e-3f;  // views do not depend on the detail
  MeshBuilder builder(spec.source, MeshBuilder::Mode::count);
  generated->build(builder, coarse);
  Scene scene = builder.take();
  scene.views.try_emplace("default");
  addNamedViews(scene, {});
  return scene;
}

}  // namespace

void SceneContext::readDetail(TomlTable& root) {
  const toml::node* node = root.find("detail");
  if (node != nullptr && !node->is_table()) {
    detail = float(root.number("detail", 1.0, 1e-6, 1.0));
  } else if (node != nullptr) {
    TomlTable table(root.file(), "'detail'", *node->as_table());
    for (const SceneInfo& info : sceneCatalogue())
      if (table.find(info.name) != nullptr)
        sceneDetail[info.name] = float(table.number(info.name, 1.0, 1e-6, 1.0));
    table.finish();
  }
  if (!options.detail) return;
  detail = *options.detail;
  sceneDetail.clear();
}

std::vector<SceneChoice> readScene(TomlTable& owner, const toml::node& node,
                                   SceneContext& context) {
  const fs::path& folder = context.folder;
  SceneChoice choice;
  choice.spec.allowOutside = context.options.allowOutside;
  const toml::table* given = node.as_table();
  if (given == nullptr) {
    choice.spec.source = resolveSource(owner, node, owner.string(node, "a scene"), false, folder);
    if (findGenerated(choice.spec.source)) choice.spec.detail = context.most(choice.spec.source);
    choice.contentHash = contentHashOf(choice.spec);
    return {choice};
  }
  TomlTable table(owner.file(), "a scene", *given);
  const std::string source = table.value<std::string>("source", "");
  if (source.empty()) table.failAt(node, "a scene needs a 'source'");
  const bool optional = table.value<bool>("optional", false);
  choice.spec.source = resolveSource(table, node, source, optional, folder);
  choice.spec.allowOutside |= table.value<bool>("allow_outside", false);
  choice.contentHash = contentHashOf(choice.spec);
  choice.spec.detail = float(table.number("detail", 1.0, 1e-6, 1.0));
  if (findGenerated(choice.spec.source))
    choice.spec.detail = context.options.detail.value_or(
        std::min(choice.spec.detail, context.most(choice.spec.source)));
  else if (const toml::node* detail = table.find("detail"))
    table.failAt(*detail,
                 fmt::format("'detail' of '{}', but only generated scenes have that knob", source));
  for (const toml::node* view : table.list("views"))
    choice.views.push_back(table.string(*view, "a view"));
  std::vector<std::optional<float>> opacities;
  for (const toml::node* opacity : table.list("opacity")) {
    const auto value = opacity->is_number() ? opacity->value<double>() : std::nullopt;
    if (!value || !(*value > 0.0 && *value <= 1.0))
      table.failAt(*opacity, fmt::format("'opacity' is {}, wanted: above 0, up to 1",
                                         TomlTable::describe(*opacity)));
    opacities.push_back(float(*value));
  }
  table.finish();
  std::error_code missing;
  if (optional && !findGenerated(choice.spec.source) && !fs::exists(choice.spec.source, missing)) {
    context.notes.push_back(
        fmt::format("optional scene {} is not there: left out", choice.spec.source));
    return {};
  }
  if (opacities.empty()) return {choice};
  std::vector<SceneChoice> choices;
  for (const auto& opacity : opacities) {
    choices.push_back(choice);
    choices.back().spec.opacity = opacity;
  }
  return choices;
}

void checkView(const SceneSpec& scene, const std::string& view) {
  try {
    findView(knownViews(scene), view);
  } catch (const InputError&) {
    const bool maybeCamera = !findGenerated(scene.source) && !view.starts_with("orbit:") &&
                             !view.starts_with("look:") && !view.starts_with("path:");
    if (!maybeCamera) throw;
    findView(loadScene(scene), view);
  }
}

}  // namespace oitlab
