#include "method/parameters.h"

#include <charconv>

#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

template <typename T>
std::optional<T> parseNumber(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

ParameterValue parseValue(const Parameter& parameter, const std::string& text,
                          const std::string& owner) {
  auto wrong = [&](const std::string& extra = "") {
    fail<InputError>("{}: parameter '{}' is '{}'{}; wanted: {}", owner, parameter.name, text, extra,
                     parameter.rangeText());
  };
  auto inRange = [&](double value) {
    if (!(value >= parameter.min && value <= parameter.max)) wrong(", out of range");
  };
  return std::visit(Overloaded{
                        [&](bool) -> ParameterValue {
                          if (text == "on" || text == "true" || text == "1") return true;
                          if (text == "off" || text == "false" || text == "0") return false;
                          wrong();
                          return false;
                        },
                        [&](std::int64_t) -> ParameterValue {
                          const auto value = parseNumber<std::int64_t>(text);
                          if (!value) wrong(", not a whole number");
                          inRange(double(*value));
                          return *value;
                        },
                        [&](double) -> ParameterValue {
                          const auto value = parseNumber<double>(text);
                          if (!value) wrong(", not a number");
                          inRange(*value);
                          return *value;
                        },
                        [&](const std::string&) -> ParameterValue {
                          if (std::find(parameter.choices.begin(), parameter.choices.end(), text) ==
                              parameter.choices.end())
                            wrong(didYouMean(text, parameter.choices));
                          return text;
                        },
                    },
                    parameter.defaultValue);
}

}  // namespace

std::string toString(const ParameterValue& value) {
  return std::visit(Overloaded{[](bool v) { return std::string(v ? "on" : "off"); },
                               [](const std::string& v) { return v; },
                               [](auto v) { return fmt::format("{}", v); }},
                    value);
}

nlohmann::json toJson(const ParameterValue& value) {
  return std::visit([](const auto& v) { return nlohmann::json(v); }, value);
}

std::string Parameter::typeName() const {
  return std::visit(
      Overloaded{[](bool) { return "bool"; }, [](std::int64_t) { return "int"; },
                 [](double) { return "float"; }, [](const std::string&) { return "enum"; }},
      defaultValue);
}

std::string Parameter::rangeText() const {
  if (std::holds_alternative<bool>(defaultValue)) return "on | off";
  if (std::holds_alternative<std::string>(defaultValue))
    return fmt::format("{}", fmt::join(choices, " | "));
  return fmt::format("{:g} to {:g}", min, max) + (unit.empty() ? "" : " " + unit);
}

Parameter flag(std::string name, bool value, std::string help) {
  return {std::move(name), value, std::move(help)};
}

Parameter integer(std::string name, std::int64_t value, std::int64_t min, std::int64_t max,
                  std::string help, std::string unit) {
  return {std::move(name), value, std::move(help), std::move(unit), double(min), double(max), {}};
}

Parameter real(std::string name, double value, double min, double max, std::string help,
               std::string unit) {
  return {std::move(name), value, std::move(help), std::move(unit), min, max, {}};
}

Parameter choice(std::string name, std::vector<std::string> choices, std::string help) {
  return {std::move(name), choices.front(), std::move(help), "", 0, 0, std::move(choices)};
}

Parameters::Parameters(const std::vector<Parameter>& declared,
                       const std::map<std::string, std::string>& given, const std::string& owner) {
  std::vector<std::string> names;
  for (const Parameter& parameter : declared) {
    names.push_back(parameter.name);
    const auto it = given.find(parameter.name);
    values_[parameter.name] =
        it == given.end() ? parameter.defaultValue : parseValue(parameter, it->second, owner);
  }
  for (const auto& [name, text] : given)
    if (!values_.contains(name)) {
      if (names.empty()) fail<InputError>("{}: unknown parameter '{}'; it has none", owner, name);
      fail<InputError>("{}: unknown parameter '{}'{}; it has: {}", owner, name,
                       didYouMean(name, names), joinNames(names));
    }
}

nlohmann::json Parameters::toJson() const {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, value] : values_) json[name] = oitlab::toJson(value);
  return json;
}

}  // namespace oitlab
