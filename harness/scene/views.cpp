#include "scene/views.h"

#include <toml++/toml.h>

#include "util/error.h"
#include "util/paths.h"

namespace oitlab {
namespace {

void addViews(Scene& scene, const std::filesystem::path& file, const std::string& tableName) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return;
  toml::table document;
  try {
    document = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    fail<InputError>("{}:{}:{}: {}", file.string(), error.source().begin.line,
                     error.source().begin.column, error.description());
  }
  const toml::node* found = document.get(tableName);
  if (!found) return;
  const toml::table* table = found->as_table();
  if (!table)
    fail<InputError>("{}:{}: '{}' is not a table of views", file.string(),
                     found->source().begin.line, tableName);
  for (const auto& [name, node] : *table) {
    const auto place = fmt::format("{}:{}", file.string(), node.source().begin.line);
    const auto view = node.value_exact<std::string>();
    if (!view)
      fail<InputError>("{}: view '{}' is not a string, expected \"orbit:...\" or \"look:...\"",
                       place, std::string_view(name.str()));
    try {
      scene.views[std::string(name.str())] = parseCamera(*view, scene.bounds);
    } catch (const InputError& error) {
      fail<InputError>("{}: {}", place, error.what());
    }
  }
}

}  // namespace

void addNamedViews(Scene& scene, const std::filesystem::path& file) {
  addViews(scene, dataRoot() / "experiments" / "scenes.toml", scene.name);
  if (file.empty()) return;
  std::filesystem::path beside = file;
  addViews(scene, beside.replace_extension(".toml"), "views");
}

}  // namespace oitlab
