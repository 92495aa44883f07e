#pragma once

#include <filesystem>

#include "measure/measure.h"
#include "scene/scene.h"

namespace oitlab {

/// One configuration of a sweep: a cell of the results is this on a device.
struct CellSpec {
  SceneSpec scene;
  std::string view = "default";
  std::uint32_t width = 0, height = 0;
  TargetFormat format = TargetFormat::rgba16f;
  std::string method;
  Parameters parameters;

  /// "boxes reference 640x360", for people.
  std::string label() const;

  /// Everything that makes this cell another one, as JSON with a fixed order of keys.
  nlohmann::json identity() const;
};

/// How a file is read: what is wanted in place of what it says.
struct ExperimentOptions {
  std::string profile = "full";  ///< "full": the file as it is; else its table [profile.NAME]
  bool profileRequired = false;  ///< false: "full" where the file has no such profile
  std::optional<float> detail;   ///< of every generated scene, (0, 1]
  std::optional<std::pair<std::uint32_t, std::uint32_t>> size;  ///< instead of all sizes
};

/// A sweep as a TOML file describes it (docs/experiments.md).
struct Experiment {
  std::string name;
  std::string title;
  std::string profile = "full";                         ///< the one that was used
  nlohmann::json overrides = nlohmann::json::object();  ///< "detail", "size" of the command line
  std::string reference = "reference";  ///< method that images are scored against; "" for none
  MeasureSettings measure;
  std::vector<CellSpec> cells;  ///< without repetitions, in the order of the file
  std::vector<std::string>
      notes;  ///< what was left out and why: optional scenes that are not there
};

/// Reads and checks an experiment. Scene paths are relative to the file. Throws InputError that
/// names file, line and key: syntax, unknown keys (with a suggestion), unknown methods or
/// parameters or profiles, values of the wrong type or out of range.
Experiment readExperiment(const std::filesystem::path& path, const ExperimentOptions& options = {});

}  // namespace oitlab
