#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace oitlab {

/// Adds the views and paths that people wrote down for this scene, in parseCamera()'s syntax: those
/// of its table in experiments/views.toml ([NAME] and [NAME.paths] for the file NAME.glb,
/// [generated.NAME] and [generated.NAME.paths] for a generated scene), then, overriding those,
/// those of the tables [views] and [paths] in a file beside `file` (x.glb: x.toml). Neither need
/// exist; `file` is empty for generated scenes. A path is a list of views, its keyframes. Needs the
/// bounds. Throws InputError naming file, line and what was found.
void addNamedViews(Scene& scene, const std::filesystem::path& file);

}  // namespace oitlab
