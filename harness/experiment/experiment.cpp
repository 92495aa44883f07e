#include "experiment/experiment.h"

#include "experiment/axes.h"
#include "experiment/measure_settings.h"
#include "experiment/profile.h"
#include "method/method.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

toml::table parse(const std::string& file) {
  try {
    std::error_code error;
    if (!fs::exists(file, error)) fail<InputError>("{}: no such file", file);
    return toml::parse_file(file);
  } catch (const toml::parse_error& error) {
    fail<InputError>("{}:{}:{}: {}", file, error.source().begin.line, error.source().begin.column,
                     error.description());
  }
}

/// Results go to a folder of this name: one step of a path, which is neither hidden nor "..".
void checkName(const TomlTable& table, const std::string& name) {
  constexpr std::size_t longest = 100;  // bytes: file systems allow 255
  const bool printable =
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; });
  if (!name.empty() && name.size() <= longest && printable && name.front() != '.' &&
      name.find_first_of("/\\") == name.npos)
    return;
  const toml::node* node = table.table().get("name");
  table.failAt(
      node ? *node : table.table(),
      fmt::format("the name '{}' cannot be that of a folder; wanted: 1 to {} characters, "
                  "no '/' or '\\', no '.' at the beginning{}",
                  name, longest, node ? "" : "; give the file another, or say name = ..."));
}

Experiment readWithProfile(const fs::path& path, const ExperimentOptions& options) {
  const std::string file = path.string();
  toml::table root = parse(file);
  Experiment experiment;
  experiment.profile = applyProfile(file, root, options);
  if (options.detail) experiment.overrides["detail"] = *options.detail;
  if (options.size) experiment.overrides["size"] = {options.size->first, options.size->second};
  TomlTable table(file, "the experiment", root);
  table.find("profile");  // applied, or not wanted
  experiment.name = table.value<std::string>("name", path.stem().string());
  checkName(table, experiment.name);
  experiment.title = table.value<std::string>("title", experiment.name);
  experiment.reference = table.value<std::string>("reference", experiment.reference);
  if (!experiment.reference.empty()) try {
      findMethod(experiment.reference);
    } catch (const InputError& error) {
      table.failAt(*table.find("reference"), error.what());
    }
  experiment.measure.seed = std::uint64_t(table.whole("seed", 1, 0, 1'000'000'000'000'000));
  if (const toml::node* node = table.find("measure"))
    readMeasureSettings(table, *node, experiment.measure);

  SceneContext context{
      path.has_parent_path() ? path.parent_path() : fs::path("."), options, 1.0f, {}, {}};
  context.readDetail(table);
  Axes axes;
  readAxes(table, axes, context);
  const auto sweeps = table.list("sweep");
  table.finish();
  std::set<std::string> known;
  addProduct(table, axes, known, experiment.cells);
  for (const toml::node* node : sweeps) {
    if (!node->is_table()) table.failAt(*node, "'sweep' must be tables: [[sweep]]");
    TomlTable sweep(file, "[[sweep]]", *node->as_table());
    Axes own = axes;
    readAxes(sweep, own, context);
    sweep.finish();
    addProduct(sweep, own, known, experiment.cells);
  }
  experiment.notes = std::move(context.notes);
  if (experiment.cells.empty() && experiment.notes.empty())
    fail<InputError>("{}: no cells: it needs 'scenes' and 'methods', at the top or in a [[sweep]]",
                     file);
  return experiment;
}

}  // namespace

Experiment readExperiment(const fs::path& path, const ExperimentOptions& options) {
  Experiment experiment = readWithProfile(path, options);
  // A mistake in a profile that is not wanted now is one all the same.
  const ExperimentOptions full{.allowOutside = options.allowOutside};
  for (const std::string& name : profileNames(path.string(), parse(path.string()))) {
    ExperimentOptions other = full;
    other.profile = name;
    if (name != experiment.profile) readWithProfile(path, other);
  }
  if (experiment.profile != "full") readWithProfile(path, full);
  return experiment;
}

}  // namespace oitlab
