#pragma once

#include "experiment/experiment.h"
#include "experiment/toml_reader.h"

namespace oitlab {

/// A scene of the file, with the views that it names itself.
struct SceneChoice {
  SceneSpec spec;
  std::string contentHash;         ///< CellSpec::contentHash
  std::vector<std::string> views;  ///< empty: those of the sweep
};

/// What reading a scene needs to know of the experiment around it.
struct SceneContext {
  std::filesystem::path folder;  ///< that paths are relative to
  ExperimentOptions options;
  float detail = 1.0f;                       ///< of generated scenes, at most
  std::map<std::string, float> sceneDetail;  ///< of these, at most
  std::vector<std::string> notes;            ///< gets what is left out, and why

  /// Reads `detail` of the experiment: one number for all generated scenes, or a table of some by
  /// name. That of the command line replaces both.
  void readDetail(TomlTable& root);

  float most(const std::string& source) const {
    const auto own = sceneDetail.find(source);
    return own == sceneDetail.end() ? detail : own->second;
  }
};

/// One element of `scenes`: a choice for each of its opacities, none for an optional scene that is
/// not there. Throws InputError with file and line.
std::vector<SceneChoice> readScene(TomlTable& owner, const toml::node& node, SceneContext& context);

/// Throws InputError where the scene has no such view. Loads nothing if it can: only a view that no
/// file of views names may be a camera within the scene's own file.
void checkView(const SceneSpec& scene, const std::string& view);

}  // namespace oitlab
