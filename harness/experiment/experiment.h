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

/// A sweep as a TOML file describes it (docs/experiments.md).
struct Experiment {
  std::string name;
  std::string title;
  std::string reference = "reference";  ///< method that images are scored against; "" for none
  MeasureSettings measure;
  std::vector<CellSpec> cells;  ///< without repetitions, in the order of the file
  std::vector<std::string>
      notes;  ///< what was left out and why: optional scenes that are not there
};

/// Reads and checks an experiment. Scene paths are relative to the file. Throws InputError that
/// names file, line and key: syntax, unknown keys (with a suggestion), unknown methods or
/// parameters, values of the wrong type or out of range. `onCpu`: with what its [cpu_device] says,
/// so that a CPU device comes to the end too.
Experiment readExperiment(const std::filesystem::path& path, bool onCpu = false);

}  // namespace oitlab
