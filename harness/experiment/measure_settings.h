#pragma once

#include <nlohmann/json.hpp>

#include "experiment/toml_reader.h"
#include "measure/measure.h"

namespace oitlab {

/// Reads [measure], which is at `node` of `root`, into `settings`: what it does not name stays.
/// Throws InputError with file and line.
void readMeasureSettings(TomlTable& root, const toml::node& node, MeasureSettings& settings);

/// The settings by their names in [measure], and "seed": `measure` of a cell.
nlohmann::json describeMeasureSettings(const MeasureSettings& settings);

}  // namespace oitlab
