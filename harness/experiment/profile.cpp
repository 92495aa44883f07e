#include "experiment/profile.h"

#include <algorithm>

namespace oitlab {

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
  const std::vector<std::string> names = profileNames(file, root);
  if (options.profile == "full") return "full";
  const bool there = std::find(names.begin(), names.end(), options.profile) != names.end();
  if (!there && !options.profileRequired) return "full";
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
