#include "experiment/experiment.h"

#include "experiment/toml_reader.h"
#include "util/size.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

struct SceneChoice {
  SceneSpec spec;
  std::vector<std::string> views;  ///< empty: those of the sweep
};

struct MethodChoice {
  std::string name;
  Parameters parameters;
};

/// What one table of the file spans: the top level, or a [[sweep]] that inherits what it leaves
/// out.
struct Axes {
  std::vector<SceneChoice> scenes;
  std::vector<std::string> views{"default"};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{1280, 720}};
  std::vector<MethodChoice> methods;
  TargetFormat format = TargetFormat::rgba16f;
};

/// What reading a scene needs to know of the experiment around it.
struct Context {
  fs::path folder;
  ExperimentOptions options;
  float detail = 1.0f;                       ///< of generated scenes, at most
  std::map<std::string, float> sceneDetail;  ///< of these, at most
  std::vector<std::string> notes;

  float most(const std::string& source) const {
    const auto own = sceneDetail.find(source);
    return own == sceneDetail.end() ? detail : own->second;
  }
};

bool isGenerated(const std::string& source) {
  const auto catalogue = sceneCatalogue();
  return std::any_of(catalogue.begin(), catalogue.end(),
                     [&](const SceneInfo& info) { return info.name == source; });
}

/// Names of generated scenes stay; paths are taken relative to the experiment's folder. A scene
/// that is neither is said now, not when its turn comes after an hour of measuring.
std::string resolveSource(const TomlTable& owner, const toml::node& node, const std::string& source,
                          bool optional, const fs::path& folder) {
  std::vector<std::string> names;
  for (const SceneInfo& info : sceneCatalogue()) {
    if (info.name == source) return source;
    names.push_back(info.name);
  }
  const fs::path path(source);
  const std::string resolved =
      path.is_absolute() ? source : fs::relative(folder / path).generic_string();
  if (!optional && !fs::exists(resolved))
    owner.failAt(node, fmt::format("scene '{}' is neither a generated one ({}) nor a file{}",
                                   source, joinNames(names), didYouMean(source, names)));
  return resolved;
}

std::vector<SceneChoice> readScene(TomlTable& owner, const toml::node& node, Context& context) {
  const fs::path& folder = context.folder;
  SceneChoice choice;
  const toml::table* given = node.as_table();
  if (given == nullptr) {
    choice.spec.source = resolveSource(owner, node, owner.string(node, "a scene"), false, folder);
    if (isGenerated(choice.spec.source)) choice.spec.detail = context.most(choice.spec.source);
    return {choice};
  }
  TomlTable table(owner.file(), "a scene", *given);
  const std::string source = table.value<std::string>("source", "");
  if (source.empty()) table.failAt(node, "a scene needs a 'source'");
  const bool optional = table.value<bool>("optional", false);
  choice.spec.source = resolveSource(table, node, source, optional, folder);
  choice.spec.detail = float(table.number("detail", 1.0, 1e-6, 1.0));
  if (isGenerated(choice.spec.source))
    choice.spec.detail = context.options.detail.value_or(
        std::min(choice.spec.detail, context.most(choice.spec.source)));
  for (const toml::node* view : table.list("views"))
    choice.views.push_back(table.string(*view, "a view"));
  std::vector<std::optional<float>> opacities;
  for (const toml::node* opacity : table.list("opacity")) {
    const auto value = opacity->value<double>();
    if (!value || !(*value > 0.0 && *value <= 1.0))
      table.failAt(*opacity, fmt::format("'opacity' is {}, wanted: above 0, up to 1",
                                         TomlTable::describe(*opacity)));
    opacities.push_back(float(*value));
  }
  table.finish();
  if (optional && !fs::exists(choice.spec.source)) {
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

void readAxes(TomlTable& table, Axes& axes, Context& context) {
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
    for (const toml::node* node : sizes) {
      const std::string text = table.string(*node, "a size");
      const auto size = parseSize(text);
      if (!size) table.failAt(*node, fmt::format("size '{}': wanted WxH, such as 1280x720", text));
      axes.sizes.push_back(*size);
    }
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

void addProduct(const Axes& axes, std::set<std::string>& known, std::vector<CellSpec>& cells) {
  for (const SceneChoice& scene : axes.scenes)
    for (const std::string& view : scene.views.empty() ? axes.views : scene.views)
      for (const auto& [width, height] : axes.sizes)
        for (const MethodChoice& method : axes.methods) {
          CellSpec cell{scene.spec,       view, width, height, axes.format, method.name,
                        method.parameters};
          if (known.insert(cell.identity().dump()).second) cells.push_back(std::move(cell));
        }
}

/// `detail`: one number for all generated scenes, or a table of some by name.
void readDetail(TomlTable& root, Context& context) {
  const toml::node* node = root.find("detail");
  if (node == nullptr) return;
  if (!node->is_table()) {
    context.detail = float(root.number("detail", 1.0, 1e-6, 1.0));
    return;
  }
  TomlTable table(root.file(), "'detail'", *node->as_table());
  for (const SceneInfo& info : sceneCatalogue())
    if (table.find(info.name) != nullptr)
      context.sceneDetail[info.name] = float(table.number(info.name, 1.0, 1e-6, 1.0));
  table.finish();
}

void readMeasure(TomlTable& root, const toml::node& node, MeasureSettings& settings) {
  if (!node.is_table()) root.failAt(node, "'measure' must be a table: [measure]");
  TomlTable table(root.file(), "[measure]", *node.as_table());
  StopRule::Limits& stop = settings.stop;
  stop.timeLimitSeconds = table.number("time_limit", stop.timeLimitSeconds, 0.01, 3600);
  stop.relativeSpread = table.number("relative_spread", stop.relativeSpread, 1e-5, 1.0);
  stop.minBlocks = int(table.number("min_blocks", stop.minBlocks, 1, 1000));
  stop.maxBlocks = int(table.number("max_blocks", stop.maxBlocks, 1, 100000));
  settings.stageFrames = int(table.number("stage_frames", settings.stageFrames, 1, 1000));
  settings.blockSeconds = table.number("block_seconds", settings.blockSeconds, 1e-4, 60);
  settings.minFrames = int(table.number("min_frames", settings.minFrames, 1, 1000));
  settings.maxFrames = int(table.number("max_frames", settings.maxFrames, 1, 10000));
  table.finish();
  if (stop.minBlocks > stop.maxBlocks || settings.minFrames > settings.maxFrames)
    root.failAt(node, "in [measure] a minimum is above its maximum");
}

/// Puts what [profile.NAME] says in place of what the file says at its top; tables such as
/// [measure] key by key.
void applyProfile(const std::string& file, toml::table& root, const ExperimentOptions& options,
                  std::string& used) {
  used = "full";
  const toml::node* node = root.get("profile");
  if (node && !node->is_table())
    fail<InputError>("{}:{}: 'profile' must be tables: [profile.cpu]", file,
                     node->source().begin.line);
  std::vector<std::string> names;
  if (node)
    for (const auto& [name, table] : *node->as_table()) names.emplace_back(name.str());
  if (options.profile == "full") return;
  const bool there = std::find(names.begin(), names.end(), options.profile) != names.end();
  if (!there && !options.profileRequired) return;
  if (!there)
    fail<InputError>("{}: no [profile.{}]{}; there are: full{}{}", file, options.profile,
                     didYouMean(options.profile, names), names.empty() ? "" : ", ",
                     joinNames(names));
  toml::node& chosen = *root.get("profile")->as_table()->get(options.profile);
  if (!chosen.is_table())
    fail<InputError>("{}:{}: '{}' must be a table: [profile.{}]", file, chosen.source().begin.line,
                     options.profile, options.profile);
  TomlTable profile(file, fmt::format("[profile.{}]", options.profile), *chosen.as_table());
  for (const char* key : {"scenes", "views", "sizes", "methods", "sweep", "detail", "measure"})
    profile.find(key);
  profile.finish();
  for (auto&& [key, value] : *chosen.as_table()) {
    // Moved, because copies of nodes forget their place in the file.
    toml::table* target = root.get(key) ? root.get(key)->as_table() : nullptr;
    if (toml::table* own = value.as_table(); own && target) {
      for (auto&& [inner, given] : *own)
        given.visit(
            [&](auto& concrete) { target->insert_or_assign(inner.str(), std::move(concrete)); });
    } else {
      value.visit([&](auto& concrete) { root.insert_or_assign(key.str(), std::move(concrete)); });
    }
  }
  used = options.profile;
}

}  // namespace

std::string CellSpec::label() const {
  std::string text = fs::path(scene.source).stem().string();
  if (scene.opacity) text += fmt::format(" opacity {:g}", *scene.opacity);
  if (view != "default") text += " " + view;
  text += " " + method;
  if (method.empty()) return text;
  for (const Parameter& parameter : findMethod(method).parameters) {
    const ParameterValue& value = parameters.all().at(parameter.name);
    if (value != parameter.defaultValue)
      text += fmt::format(" {}={}", parameter.name, toString(value));
  }
  return text + fmt::format(" {}x{}", width, height);
}

nlohmann::json CellSpec::identity() const {
  nlohmann::json json;
  // A file is known by name and size, not by path: results may be resumed from another folder.
  const fs::path path(scene.source);
  std::error_code missing;
  const auto bytes = fs::file_size(path, missing);
  json["scene"] = {{"source", path.filename().string()}, {"detail", scene.detail}};
  if (!missing) json["scene"]["bytes"] = bytes;
  if (scene.opacity) json["scene"]["opacity"] = *scene.opacity;
  json["view"] = view;
  json["size"] = {width, height};
  json["format"] = formatName(format);
  json["method"] = method;
  json["parameters"] = parameters.toJson();
  return json;
}

Experiment readExperiment(const fs::path& path, const ExperimentOptions& options) {
  const std::string file = path.string();
  toml::table root;
  try {
    if (!fs::exists(path)) fail<InputError>("{}: no such file", file);
    root = toml::parse_file(file);
  } catch (const toml::parse_error& error) {
    fail<InputError>("{}:{}:{}: {}", file, error.source().begin.line, error.source().begin.column,
                     error.description());
  }
  Experiment experiment;
  applyProfile(file, root, options, experiment.profile);
  if (options.detail) experiment.overrides["detail"] = *options.detail;
  if (options.size) experiment.overrides["size"] = {options.size->first, options.size->second};
  TomlTable table(file, "the experiment", root);
  table.find("profile");  // applied, or not wanted
  experiment.name = table.value<std::string>("name", path.stem().string());
  experiment.title = table.value<std::string>("title", experiment.name);
  experiment.reference = table.value<std::string>("reference", experiment.reference);
  if (!experiment.reference.empty()) try {
      findMethod(experiment.reference);
    } catch (const InputError& error) {
      table.failAt(*table.find("reference"), error.what());
    }
  experiment.measure.seed = std::uint64_t(table.number("seed", 1, 0, 1e15));
  if (const toml::node* node = table.find("measure")) readMeasure(table, *node, experiment.measure);

  Context context{
      path.has_parent_path() ? path.parent_path() : fs::path("."), options, 1.0f, {}, {}};
  readDetail(table, context);
  if (options.detail) {
    context.detail = *options.detail;
    context.sceneDetail.clear();
  }
  Axes axes;
  readAxes(table, axes, context);
  const auto sweeps = table.list("sweep");
  table.finish();
  std::set<std::string> known;
  addProduct(axes, known, experiment.cells);
  for (const toml::node* node : sweeps) {
    if (!node->is_table()) table.failAt(*node, "'sweep' must be tables: [[sweep]]");
    TomlTable sweep(file, "[[sweep]]", *node->as_table());
    Axes own = axes;
    readAxes(sweep, own, context);
    sweep.finish();
    addProduct(own, known, experiment.cells);
  }
  experiment.notes = std::move(context.notes);
  if (experiment.cells.empty() && experiment.notes.empty())
    fail<InputError>("{}: no cells: it needs 'scenes' and 'methods', at the top or in a [[sweep]]",
                     file);
  return experiment;
}

}  // namespace oitlab
