#include "experiment/profile.h"

#include <algorithm>

namespace oitlab {

namespace {

/// The most that [measure] asks for in the profile `brief`, which every experiment has.
constexpr std::string_view briefLimits = R"(
time_limit = 2
block_seconds = 0.02
min_blocks = 6  # fewer give no interval
max_blocks = 20
min_frames = 1
max_frames = 20
stage_frames = 5
)";

/// Lowers [measure] to those limits.
void makeBrief(toml::table& root) {
  if (!root.contains("measure")) root.insert("measure", toml::table());
  toml::table* measure = root.get("measure")->as_table();
  if (!measure) return;  // a mistake, which is found when it is read
  for (auto&& [key, limit] : toml::parse(briefLimits)) {
    const toml::node* given = measure->get(key);
    if (!given || given->value<double>() > limit.value<double>())
      measure->insert_or_assign(key, limit);
  }
}

}  // namespace

std::vector<std::string> profileNames(const std::string& file, const toml::table& root) {
  const toml::node* node = root.get("profile");
  if (node == nullptr) return {};
  if (!node->is_table())
    fail<InputError>("{}:{}: 'profile' must be tables: [profile.cpu]", file,
                     node->source().begin.line);
  std::vector<std::string> names;
  for (const auto& [name, table] : *node->as_table()) {
    if (name.str() == "full")
      fail<InputError>("{}:{}: [profile.full] is the file without a profile; choose another name",
                       file, table.source().begin.line);
    names.emplace_back(name.str());
  }
  return names;
}

std::string applyProfile(const std::string& file, toml::table& root,
                         const ExperimentOptions& options) {
  std::vector<std::string> names = profileNames(file, root);
  if (options.profile == "full") return "full";
  const bool brief = options.profile == "brief";
  if (brief) makeBrief(root);
  if (std::find(names.begin(), names.end(), options.profile) == names.end()) {
    if (brief) return "brief";
    if (!options.profileRequired) return "full";
    names.insert(names.begin(), "full");
    if (std::find(names.begin(), names.end(), "brief") == names.end()) names.push_back("brief");
    fail<InputError>("{}: no [profile.{}]{}; there are: {}", file, options.profile,
                     didYouMean(options.profile, names), joinNames(names));
  }
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
        given.visit([&, name = inner.str()](auto& concrete) {
          target->insert_or_assign(name, std::move(concrete));
        });
    } else {
      value.visit([&, name = key.str()](auto& concrete) {
        root.insert_or_assign(name, std::move(concrete));
      });
    }
  }
  return options.profile;
}

}  // namespace oitlab
