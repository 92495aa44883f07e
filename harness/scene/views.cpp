#include "scene/views.h"

#include <toml++/toml.h>

#include "util/error.h"
#include "util/paths.h"

namespace oitlab {
namespace {

constexpr std::string_view pathsTable = "paths";

std::string placeOf(const std::filesystem::path& file, const toml::node& node) {
  return fmt::format("{}:{}", file.string(), node.source().begin.line);
}

toml::table parseFile(const std::filesystem::path& file) {
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    fail<InputError>("{}:{}:{}: {}", file.string(), error.source().begin.line,
                     error.source().begin.column, error.description());
  }
}

Camera parseAt(const std::string& place, const std::string& text, const Bounds& bounds) {
  try {
    return parseCamera(text, bounds);
  } catch (const InputError& error) {
    fail<InputError>("{}: {}", place, error.what());
  }
}

void addPath(Scene& scene, const std::filesystem::path& file, const std::string& name,
             const toml::node& node) {
  const toml::array* list = node.as_array();
  if (!list || list->empty())
    fail<InputError>("{}: path '{}' is not a list of views, expected [\"look:...\", ...]",
                     placeOf(file, node), name);
  std::vector<Camera> keyframes;
  for (const toml::node& element : *list) {
    const auto text = element.value_exact<std::string>();
    if (!text)
      fail<InputError>("{}: path '{}': a keyframe is not a string, expected \"look:...\"",
                       placeOf(file, element), name);
    keyframes.push_back(parseAt(placeOf(file, element), *text, scene.bounds));
  }
  scene.paths.insert_or_assign(name, CameraPath(std::move(keyframes)));
}

void addPaths(Scene& scene, const std::filesystem::path& file, const toml::node& node) {
  const toml::table* table = node.as_table();
  if (!table) fail<InputError>("{}: '{}' is not a table of paths", placeOf(file, node), pathsTable);
  for (const auto& [name, path] : *table) addPath(scene, file, std::string(name.str()), path);
}

void addViews(Scene& scene, const std::filesystem::path& file, const toml::node* found,
              const std::string& tableName) {
  if (!found) return;
  const toml::table* table = found->as_table();
  if (!table)
    fail<InputError>("{}: '{}' is not a table of views", placeOf(file, *found), tableName);
  for (const auto& [name, node] : *table) {
    if (name.str() == pathsTable) {
      addPaths(scene, file, node);
      continue;
    }
    const auto view = node.value_exact<std::string>();
    if (!view)
      fail<InputError>("{}: view '{}' is not a string, expected \"orbit:...\" or \"look:...\"",
                       placeOf(file, node), std::string_view(name.str()));
    scene.views[std::string(name.str())] = parseAt(placeOf(file, node), *view, scene.bounds);
  }
}

}  // namespace

void addNamedViews(Scene& scene, const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::path shared = dataRoot() / "experiments" / "views.toml";
  if (std::filesystem::exists(shared, ignored)) {
    const toml::table document = parseFile(shared);
    if (!file.empty()) {
      addViews(scene, shared, document.get(scene.name), scene.name);
    } else if (const toml::node* generated = document.get("generated")) {
      const toml::table* tables = generated->as_table();
      if (!tables)
        fail<InputError>("{}: 'generated' is not a table of scenes", placeOf(shared, *generated));
      addViews(scene, shared, tables->get(scene.name), "generated." + scene.name);
    }
  }
  std::filesystem::path beside = file;
  if (file.empty() || !std::filesystem::exists(beside.replace_extension(".toml"), ignored)) return;
  const toml::table document = parseFile(beside);
  addViews(scene, beside, document.get("views"), "views");
  if (const toml::node* paths = document.get(pathsTable)) addPaths(scene, beside, *paths);
}

}  // namespace oitlab
