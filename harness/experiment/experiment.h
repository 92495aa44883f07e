#pragma once

#include <filesystem>

#include "experiment/cell.h"
#include "measure/measure.h"

namespace oitlab {

/// How a file is read: what is wanted in place of what it says.
struct ExperimentOptions {
  std::string profile = "full";  ///< "full": the file as it is; "brief"; or a [profile.NAME]
  bool profileRequired = false;  ///< false: "full" where the file has no such profile
  std::optional<float> detail;   ///< of every generated scene, (0, 1]
  std::optional<std::pair<std::uint32_t, std::uint32_t>> size;  ///< instead of all sizes
  bool allowOutside = false;  ///< every scene file may name files outside its folder
};

/// A sweep as a TOML file describes it (docs/experiments.md).
struct Experiment {
  std::string name;  ///< results go to a folder of this name: no path
  std::string title;
  std::string profile = "full";                         ///< the one that was used
  nlohmann::json overrides = nlohmann::json::object();  ///< "detail", "size" of the command line
  std::string reference = "reference";  ///< method that images are scored against; "" for none
  MeasureSettings measure;
  std::vector<CellSpec> cells;  ///< without repetitions, in the order of the file
  std::vector<std::string>
      notes;  ///< what was left out and why: optional scenes that are not there
};

/// Reads and checks an experiment, all its profiles included. Scene paths are relative to the file.
/// Throws InputError that names file, line, what was found and what was wanted: syntax, unknown
/// keys (with a suggestion), unknown scenes, views, methods, parameters or profiles, values of the
/// wrong type or out of range.
Experiment readExperiment(const std::filesystem::path& path, const ExperimentOptions& options = {});

}  // namespace oitlab
