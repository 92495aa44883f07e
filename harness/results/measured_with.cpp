#include "results/measured_with.h"

#include <sstream>

#include "experiment/measure_settings.h"
#include "util/error.h"
#include "util/version.h"

namespace oitlab {
namespace {

using nlohmann::json;

/// Fields of a cell that must agree, and what a difference is called.
constexpr std::pair<const char*, const char*> fields[] = {
    {"/profile", "the profile"},
    {"/reference", "the reference"},
    {"/provenance/build", "the build"},
    {"/provenance/source", "the program's source"},
    {"/provenance/validation", "validation"},
};

json find(const json& cell, const std::string& pointer) {
  const json::json_pointer place(pointer);
  return cell.contains(place) ? cell.at(place) : json();
}

std::string text(const json& value) {
  if (value.is_null()) return "not recorded";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

MeasuredWith::MeasuredWith(const Experiment& experiment, const Device::Options& device)
    : shaders_(device.shaderPrintf) {
  const bool validation = device.validation || device.shaderPrintf;
  now_ = {{"profile", experiment.profile},
          {"reference", experiment.reference},
          {"measure", describeMeasureSettings(experiment.measure)},
          {"provenance",
           {{"build", buildType()}, {"source", builtSource()}, {"validation", validation}}}};
}

void MeasuredWith::describe(json& cell) const {
  cell.merge_patch(now_);
}

std::vector<std::string> MeasuredWith::differences(const json& cell) {
  std::vector<std::string> found;
  const auto compare = [&](const std::string& pointer, const std::string& name) {
    const json then = find(cell, pointer), now = find(now_, pointer);
    if (then != now) found.push_back(fmt::format("{} is {}, now {}", name, text(then), text(now)));
  };
  for (const auto& [pointer, name] : fields) compare(pointer, name);
  for (const auto& [name, value] : now_.at("measure").items())
    compare("/measure/" + name, "measure." + name);
  const json shaders = find(cell, "/provenance/shaders");
  if (!shaders.is_object()) return found;
  for (const auto& [label, hash] : shaders.items())
    if (hash != shaderHash(label)) found.push_back(fmt::format("shader {} has changed", label));
  return found;
}

std::string MeasuredWith::shaderHash(const std::string& label) {
  const auto known = hashes_.find(label);
  if (known != hashes_.end()) return known->second;
  std::string hash;
  try {
    hash = shaders_.hash(label);
  } catch (const InputError&) {
    // It is gone, or no longer to be read: it has changed.
  }
  return hashes_[label] = hash;
}

}  // namespace oitlab
