#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace oitlab {

/// Adds the views that people wrote down for this scene, in parseCamera()'s syntax: those of the
/// table of its name in experiments/scenes.toml, then, overriding those, those of the table
/// [views] in a file beside `file` (x.glb: x.toml). Neither need exist; `file` is empty for
/// generated scenes. Needs the bounds. Throws InputError naming file, line and what was found.
void addNamedViews(Scene& scene, const std::filesystem::path& file);

}  // namespace oitlab
