#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

namespace oitlab {

/// A parameter's value. Enumerations are strings.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

std::string toString(const ParameterValue& value);
nlohmann::json toJson(const ParameterValue& value);

/// The declaration of a parameter. The command line, the checks of experiments, `oitlab list
/// methods` and the columns of the results all follow from it. The type is that of `defaultValue`.
struct Parameter {
  std::string name;
  ParameterValue defaultValue;
  std::string help;                  ///< one line
  std::string unit = "";             ///< "" for a pure number
  double min = 0, max = 0;           ///< for numbers, inclusive
  std::vector<std::string> choices;  ///< for enumerations

  std::string typeName() const;  ///< "bool", "int", "float" or "enum"

  /// "1 to 16", "submission | sorted", "on | off".
  std::string rangeText() const;
};

Parameter flag(std::string name, bool value, std::string help);
Parameter integer(std::string name, std::int64_t value, std::int64_t min, std::int64_t max,
                  std::string help, std::string unit = "");
Parameter real(std::string name, double value, double min, double max, std::string help,
               std::string unit = "");
/// The first choice is the default.
Parameter choice(std::string name, std::vector<std::string> choices, std::string help);

/// The values of all parameters of one method. Every declared parameter has a value in its range.
class Parameters {
 public:
  Parameters() = default;

  /// The defaults of `declared`, replaced by the values of `given`: name -> text from the command
  /// line or a TOML file. Throws InputError for an unknown name, with a suggestion, and for a value
  /// of the wrong type or out of range, with the range. `owner` names the method in messages.
  Parameters(const std::vector<Parameter>& declared,
             const std::map<std::string, std::string>& given, const std::string& owner);

  bool flag(const std::string& name) const { return get<bool>(name); }
  std::int64_t integer(const std::string& name) const { return get<std::int64_t>(name); }
  double real(const std::string& name) const { return get<double>(name); }
  const std::string& choice(const std::string& name) const { return get<std::string>(name); }

  const std::map<std::string, ParameterValue>& all() const { return values_; }
  nlohmann::json toJson() const;

 private:
  template <typename T>
  const T& get(const std::string& name) const {
    return std::get<T>(values_.at(name));
  }
  std::map<std::string, ParameterValue> values_;
};

}  // namespace oitlab
