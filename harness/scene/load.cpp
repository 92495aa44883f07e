#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>

#include "scene/generate/generators.h"
#include "scene/import/gltf.h"
#include "scene/import/obj.h"
#include "scene/scene.h"
#include "scene/views.h"
#include "util/error.h"
#include "util/suggest.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

void checkShare(const std::string& source, const char* what, float value) {
  if (!(value > 0.0f && value <= 1.0f))
    fail<InputError>("scene '{}': {} is {}, expected more than 0 and at most 1", source, what,
                     value);
}

[[noreturn]] void failUnknown(const std::string& source) {
  std::vector<std::string> names;
  for (const GeneratedScene* scene : generatedScenes()) names.emplace_back(scene->name);
  fail<InputError>("scene '{}': neither a file nor a built-in scene{}; built in are {}", source,
                   didYouMean(source, names), joinNames(names));
}

Scene generate(const GeneratedScene& generated, float detail) {
  MeshBuilder builder(generated.name);
  generated.build(builder, detail);
  return builder.take();
}

Scene loadFile(const SceneSpec& spec) {
  const std::filesystem::path path = spec.source;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) failUnknown(spec.source);
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  const bool gltf = extension == ".glb" || extension == ".gltf";
  if ((!gltf && extension != ".obj") || std::filesystem::is_directory(path, ignored))
    fail<InputError>("{}: expected a .glb, .gltf or .obj file", spec.source);
  // Otherwise the results would have a column for a value that has no effect.
  if (spec.detail != 1.0f)
    fail<InputError>("{}: detail is {}, but only generated scenes have that knob", spec.source,
                     spec.detail);
  checkRegularFile(path);
  return gltf ? loadGltf(path, spec.allowOutside) : loadObj(path, spec.allowOutside);
}

}  // namespace

Scene loadScene(const SceneSpec& spec) {
  checkShare(spec.source, "detail", spec.detail);
  if (spec.opacity) checkShare(spec.source, "opacity", *spec.opacity);
  const GeneratedScene* generated = findGenerated(spec.source);
  Scene scene = generated ? generate(*generated, spec.detail) : loadFile(spec);
  computeBounds(scene);
  if (spec.opacity) overrideOpacity(scene, *spec.opacity);
  scene.views.try_emplace("default", overviewCamera(scene.bounds));
  addNamedViews(scene, generated ? std::filesystem::path() : std::filesystem::path(spec.source));
  return scene;
}

namespace {

// "path:NAME@T"
Camera findOnPath(const Scene& scene, const std::string& view) {
  const std::size_t at = view.rfind('@');
  if (at == std::string::npos)
    fail<InputError>("view '{}': expected 'path:NAME@T' with T from 0 to 1", view);
  const std::string name = view.substr(5, at - 5);
  const auto path = scene.paths.find(name);
  if (path == scene.paths.end()) {
    std::vector<std::string> names;
    for (const auto& [known, ignored] : scene.paths) names.push_back(known);
    fail<InputError>("view '{}': scene '{}' has no path '{}'{}; it has {}", view, scene.name, name,
                     didYouMean(name, names), names.empty() ? "none" : joinNames(names));
  }
  float t = -1.0f;
  const char* end = view.data() + view.size();
  const auto [stop, error] = std::from_chars(view.data() + at + 1, end, t);
  if (error != std::errc{} || stop != end || !(t >= 0.0f && t <= 1.0f))
    fail<InputError>("view '{}': '{}' is not a number from 0 to 1", view, view.substr(at + 1));
  return path->second.at(t);
}

}  // namespace

Camera findView(const Scene& scene, const std::string& view) {
  if (const auto named = scene.views.find(view); named != scene.views.end()) return named->second;
  if (view.starts_with("path:")) return findOnPath(scene, view);
  if (view.starts_with("orbit:") || view.starts_with("look:"))
    return parseCamera(view, scene.bounds);
  std::vector<std::string> names;
  for (const auto& [name, camera] : scene.views) names.push_back(name);
  fail<InputError>(
      "view '{}': scene '{}' has no such view{}; it has {}, and 'orbit:...' or 'look:...' make one",
      view, scene.name, didYouMean(view, names), joinNames(names));
}

}  // namespace oitlab
