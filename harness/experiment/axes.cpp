#include "experiment/axes.h"

#include "method/method.h"
#include "util/size.h"

namespace oitlab {
namespace {

/// A parameter's value as text, as the command line would give it.
std::string valueText(const TomlTable& table, const toml::node& node, const std::string& key) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* flag = node.as_boolean()) return flag->get() ? "on" : "off";
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  table.failAt(node, fmt::format("parameter '{}' must be a string, number or boolean", key));
}

/// All combinations of a method's parameter lists, the last key varying fastest.
std::vector<MethodChoice> readMethod(TomlTable& owner, const toml::node& node) {
  const toml::table empty;
  const toml::table* given = node.as_table();
  TomlTable table(owner.file(), "a method", given ? *given : empty);
  const std::string name =
      given ? table.value<std::string>("method", "") : owner.string(node, "a method");
  if (name.empty()) table.failAt(node, "a method needs a 'method', its name");
  try {
    const MethodInfo& info = findMethod(name);
    std::vector<std::map<std::string, std::string>> combinations(1);
    for (const auto& [key, values] : table.rest()) {
      std::vector<std::map<std::string, std::string>> longer;
      for (const auto& combination : combinations)
        for (const toml::node* value : table.list(key)) {
          longer.push_back(combination);
          longer.back()[key] = valueText(table, *value, key);
        }
      combinations = std::move(longer);
    }
    std::vector<MethodChoice> choices;
    choices.reserve(combinations.size());
    for (const auto& combination : combinations)
      choices.push_back({name, Parameters(info.parameters, combination, name)});
    return choices;
  } catch (const InputError& error) {
    // The message about a name or value gets the place.
    const std::string message = error.what();
    if (message.starts_with(owner.file() + ":")) throw;
    owner.failAt(node, message);
  }
}

std::pair<std::uint32_t, std::uint32_t> readSize(const TomlTable& table, const toml::node& node) {
  const std::string text = table.string(node, "a size");
  const auto size = parseSize(text);
  if (!size || size->first == 0 || size->second == 0)
    table.failAt(node, fmt::format("size '{}': wanted WxH, such as 1280x720", text));
  return *size;
}

/// The node that names this view, for the line of a message: in `views`, or in that of a scene.
const toml::node& findViewNode(const TomlTable& table, const std::string& view) {
  const auto within = [&](const toml::node* list) -> const toml::node* {
    if (list == nullptr) return nullptr;
    if (list->value_exact<std::string>() == view) return list;
    if (const toml::array* array = list->as_array())
      for (const toml::node& element : *array)
        if (element.value_exact<std::string>() == view) return &element;
    return nullptr;
  };
  if (const toml::node* scenes = table.table().get("scenes"); scenes && scenes->is_array())
    for (const toml::node& scene : *scenes->as_array())
      if (const toml::table* own = scene.as_table())
        if (const toml::node* found = within(own->get("views"))) return *found;
  if (const toml::node* found = within(table.table().get("views"))) return *found;
  return table.table();
}

}  // namespace

void readAxes(TomlTable& table, Axes& axes, SceneContext& context) {
  if (const auto scenes = table.list("scenes"); !scenes.empty()) {
    axes.scenes.clear();
    for (const toml::node* node : scenes)
      for (SceneChoice& choice : readScene(table, *node, context))
        axes.scenes.push_back(std::move(choice));
  }
  if (const auto views = table.list("views"); !views.empty()) {
    axes.views.clear();
    for (const toml::node* node : views) axes.views.push_back(table.string(*node, "a view"));
  }
  if (const auto sizes = table.list("sizes"); !sizes.empty()) {
    axes.sizes.clear();
    for (const toml::node* node : sizes) axes.sizes.push_back(readSize(table, *node));
  }
  if (context.options.size) axes.sizes = {*context.options.size};
  if (const auto methods = table.list("methods"); !methods.empty()) {
    axes.methods.clear();
    for (const toml::node* node : methods)
      for (MethodChoice& choice : readMethod(table, *node))
        axes.methods.push_back(std::move(choice));
  }
  if (const toml::node* node = table.find("format")) {
    try {
      axes.format = parseFormat(table.string(*node, "the format"));
    } catch (const InputError& error) {
      table.failAt(*node, error.what());
    }
  }
}

void addProduct(const TomlTable& table, const Axes& axes, std::set<std::string>& known,
                std::vector<CellSpec>& cells) {
  for (const SceneChoice& scene : axes.scenes)
    for (const std::string& view : scene.views.empty() ? axes.views : scene.views) {
      try {
        checkView(scene.spec, view);
      } catch (const InputError& error) {
        table.failAt(findViewNode(table, view), error.what());
      }
      for (const auto& [width, height] : axes.sizes)
        for (const MethodChoice& method : axes.methods) {
          CellSpec cell{scene.spec, scene.contentHash, view,        width,
                        height,     axes.format,       method.name, method.parameters};
          if (known.insert(cell.identity().dump()).second) cells.push_back(std::move(cell));
        }
    }
}

}  // namespace oitlab
