#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace oitlab {

/// Adds the views and paths that are written down for this scene, in the syntax of parseCamera().
/// They come from its tables in experiments/views.toml: [NAME] and [NAME.paths] for a file
/// NAME.glb, [generated.NAME] and [generated.NAME.paths] for a generated scene. The tables [views]
/// and [paths] of a TOML file beside `file` (x.toml for x.glb) override them. Neither file need
/// exist; `file` is empty for generated scenes. A path is a list of views, its keyframes. Needs the
/// scene's bounds. Throws InputError with file, line and what was found.
void addNamedViews(Scene& scene, const std::filesystem::path& file);

}  // namespace oitlab
