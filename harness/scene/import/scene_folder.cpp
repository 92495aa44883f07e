#include "scene/import/scene_folder.h"

#include <algorithm>

#include "util/error.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

bool leadsOut(const fs::path& name) {
  const fs::path normal = name.lexically_normal();
  return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

}  // namespace

SceneFolder::SceneFolder(const fs::path& sceneFile, bool allowOutside)
    : file_(sceneFile), folder_(sceneFile.parent_path()), allowOutside_(allowOutside) {}

fs::path SceneFolder::find(const std::string& name) {
  const auto known = std::ranges::find(references_, name, &Reference::name);
  if (known != references_.end()) return known->path;
  if (!allowOutside_ && leadsOut(name))
    fail<InputError>(
        "{}: names the file '{}', which is outside the scene's folder; --allow-outside reads it",
        file_.string(), name);
  const fs::path path = folder_ / name;
  std::error_code missing;
  const fs::file_status status = fs::status(path, missing);
  if (!missing && fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
    fail<InputError>("{}: names the file '{}', which is not a regular file", file_.string(), name);
  references_.push_back({name, fs::is_regular_file(status) ? path : fs::path()});
  return references_.back().path;
}

}  // namespace oitlab
