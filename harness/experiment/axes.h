#pragma once

#include <set>

#include "experiment/scene_choice.h"

namespace oitlab {

/// A method with one choice of parameters.
struct MethodChoice {
  std::string name;
  Parameters parameters;
};

/// What one table of the file spans: the top level, or a [[sweep]] that inherits what it leaves
/// out.
struct Axes {
  std::vector<SceneChoice> scenes;
  std::vector<std::string> views{"default"};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{1280, 720}};
  std::vector<MethodChoice> methods;
  TargetFormat format = TargetFormat::rgba16f;
};

/// Replaces in `axes` what `table` names. Throws InputError with file and line.
void readAxes(TomlTable& table, Axes& axes, SceneContext& context);

/// Appends the cells of the product that are not in `known` yet. `table` is where the axes stand.
/// Throws InputError where a scene has not one of the views.
void addProduct(const TomlTable& table, const Axes& axes, std::set<std::string>& known,
                std::vector<CellSpec>& cells);

}  // namespace oitlab
