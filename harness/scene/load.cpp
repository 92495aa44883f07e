#include <algorithm>
#include <cctype>
#include <filesystem>

#include "scene/generators.h"
#include "scene/gltf.h"
#include "scene/scene.h"
#include "scene/views.h"
#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

void checkShare(const std::string& source, const char* what, float value) {
  if (!(value > 0.0f && value <= 1.0f))
    fail<InputError>("scene '{}': {} is {}, expected more than 0 and at most 1", source, what,
                     value);
}

const GeneratedScene* findGenerated(const std::string& name) {
  for (const GeneratedScene* scene : generatedScenes())
    if (scene->name == name) return scene;
  return nullptr;
}

[[noreturn]] void failUnknown(const std::string& source) {
  std::vector<std::string> names;
  for (const GeneratedScene* scene : generatedScenes()) names.emplace_back(scene->name);
  fail<InputError>("scene '{}': neither a file nor a built-in scene{}; built in are {}", source,
                   didYouMean(source, names), joinNames(names));
}

Scene loadFile(const SceneSpec& spec) {
  const std::filesystem::path path = spec.source;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) failUnknown(spec.source);
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  if ((extension != ".glb" && extension != ".gltf") || std::filesystem::is_directory(path, ignored))
    fail<InputError>("{}: expected a .glb or .gltf file", spec.source);
  // A knob without effect would end up as a column of the results that says something untrue.
  if (spec.detail != 1.0f)
    fail<InputError>("{}: detail is {}, but only generated scenes have that knob", spec.source,
                     spec.detail);
  return loadGltf(path);
}

}  // namespace

Scene loadScene(const SceneSpec& spec) {
  checkShare(spec.source, "detail", spec.detail);
  if (spec.opacity) checkShare(spec.source, "opacity", *spec.opacity);
  const GeneratedScene* generated = findGenerated(spec.source);
  Scene scene = generated ? generated->make(spec.detail) : loadFile(spec);
  computeBounds(scene);
  if (spec.opacity) overrideOpacity(scene, *spec.opacity);
  scene.views.try_emplace("default", overviewCamera(scene.bounds));
  addNamedViews(scene, generated ? std::filesystem::path() : std::filesystem::path(spec.source));
  return scene;
}

Camera findView(const Scene& scene, const std::string& view) {
  if (const auto named = scene.views.find(view); named != scene.views.end()) return named->second;
  if (view.starts_with("orbit:") || view.starts_with("look:"))
    return parseCamera(view, scene.bounds);
  std::vector<std::string> names;
  for (const auto& [name, camera] : scene.views) names.push_back(name);
  fail<InputError>(
      "view '{}': scene '{}' has no such view{}; it has {}, and 'orbit:...' or 'look:...' make one",
      view, scene.name, didYouMean(view, names), joinNames(names));
}

}  // namespace oitlab
