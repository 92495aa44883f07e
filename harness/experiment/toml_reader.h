#pragma once

#include <set>

#include <toml++/toml.h>

#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {

/// A TOML table whose keys must all be asked for: whatever is left over is a spelling mistake, and
/// is reported with file, line and a suggestion.
class TomlTable {
 public:
  TomlTable(std::string file, std::string where, const toml::table& table)
      : file_(std::move(file)), where_(std::move(where)), table_(table) {}

  const toml::node* find(const std::string& key) {
    known_.insert(key);
    return table_.get(key);
  }

  /// The value of `key`, or `fallback` when it is not there. Whole numbers pass as floats.
  template <typename T>
  T value(const std::string& key, T fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    // value() of toml++ turns true into 1 and 1 into true: those are mistakes.
    const bool right =
        std::is_same_v<T, double> ? node->is_number() : node->value_exact<T>().has_value();
    if (const auto found = node->value<T>(); right && found) return *found;
    failAt(*node, fmt::format("'{}' must be {}, found {}", key, wanted<T>(), describe(*node)));
  }

  /// A whole number within [min, max].
  std::int64_t whole(const std::string& key, std::int64_t fallback, std::int64_t min,
                     std::int64_t max) {
    const std::int64_t found = value<std::int64_t>(key, fallback);
    if (found < min || found > max)
      failAt(*table_.get(key),
             fmt::format("'{}' is {}, out of range: {} to {}", key, found, min, max));
    return found;
  }

  /// A number within [min, max].
  double number(const std::string& key, double fallback, double min, double max) {
    const double found = value<double>(key, fallback);
    if (!(found >= min && found <= max))
      failAt(*table_.get(key),
             fmt::format("'{}' is {}, out of range: {:g} to {:g}", key, found, min, max));
    return found;
  }

  /// A list, or a single value as a list of one; nullptr elements never.
  std::vector<const toml::node*> list(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    if (const toml::array* array = node->as_array()) {
      std::vector<const toml::node*> nodes;
      for (const toml::node& element : *array) nodes.push_back(&element);
      if (nodes.empty()) failAt(*node, fmt::format("'{}' is an empty list", key));
      return nodes;
    }
    return {node};
  }

  std::string string(const toml::node& node, const std::string& what) const {
    if (const auto found = node.value<std::string>()) return *found;
    failAt(node, fmt::format("{} must be a string, found {}", what, describe(node)));
  }

  /// Keys that were never asked for, in the order of the table.
  std::vector<std::pair<std::string, const toml::node*>> rest() const {
    std::vector<std::pair<std::string, const toml::node*>> keys;
    for (const auto& [key, node] : table_)
      if (!known_.contains(std::string(key.str()))) keys.emplace_back(key.str(), &node);
    return keys;
  }

  /// Throws when a key is left over.
  void finish() const {
    for (const auto& [key, node] : rest()) {
      const std::vector<std::string> names(known_.begin(), known_.end());
      failAt(*node, fmt::format("unknown key '{}' in {}{}; there are: {}", key, where_,
                                didYouMean(key, names), joinNames(names)));
    }
  }

  [[noreturn]] void failAt(const toml::node& node, const std::string& message) const {
    fail<InputError>("{}:{}: {}", file_, node.source().begin.line, message);
  }

  const toml::table& table() const { return table_; }
  const std::string& file() const { return file_; }

  static std::string describe(const toml::node& node) {
    std::ostringstream text;
    node.visit([&](const auto& concrete) { text << concrete; });
    return text.str();
  }

 private:
  template <typename T>
  static std::string wanted() {
    if constexpr (std::is_same_v<T, bool>) return "true or false";
    if constexpr (std::is_same_v<T, std::int64_t>) return "a whole number";
    if constexpr (std::is_same_v<T, double>) return "a number";
    return "a string";
  }

  std::string file_, where_;
  const toml::table& table_;
  std::set<std::string> known_;
};

}  // namespace oitlab
