#include "scene/import/content_hash.h"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <span>
#include <sstream>

#include <fmt/format.h>

#include "image/hash.h"
#include "scene/import/gltf.h"
#include "scene/import/obj.h"
#include "util/cache_file.h"
#include "util/error.h"
#include "util/paths.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

std::string hashOf(const std::string& text) {
  return imageHash(std::as_bytes(std::span(text)));
}

/// What changes with a file's contents, as one word; "none" when there is no regular file. The time
/// of its last change of state is part of it: unlike that of the last write, no program can set it
/// back (`cp -p`, `rsync -t`).
std::string stampOf(const fs::path& path) {
  struct stat found {};
  if (path.empty() || ::stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return "none";
  return fmt::format("{}:{}:{}:{}.{:09}:{}.{:09}", found.st_dev, found.st_ino, found.st_size,
                     found.st_mtim.tv_sec, found.st_mtim.tv_nsec, found.st_ctim.tv_sec,
                     found.st_ctim.tv_nsec);
}

/// Whether the file was written so recently that another write might leave the same time: file
/// systems count in steps of up to 2 s.
bool isFresh(const fs::path& path) {
  struct stat found {};
  constexpr std::time_t coarsestStep = 2;
  return ::stat(path.c_str(), &found) == 0 &&
         std::time(nullptr) - found.st_mtim.tv_sec <= coarsestStep;
}

/// The files that `file` names; none when it cannot be loaded.
std::vector<SceneFolder::Reference> referencesOf(const fs::path& file, bool allowOutside) {
  SceneFolder folder(file, allowOutside);
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  try {
    if (extension == ".obj")
      findObjFiles(file, folder);
    else
      findGltfFiles(file, folder);
  } catch (const InputError&) {
    return {};
  }
  return folder.references();
}

// The content of a cache file: the hash, then for each file its stamp and its path, a line each.
std::optional<std::string> hashFrom(const std::string& text) {
  std::istringstream lines(text);
  std::string hash, line;
  if (!std::getline(lines, hash)) return std::nullopt;
  while (std::getline(lines, line)) {
    const auto space = line.find(' ');
    if (space == std::string::npos || stampOf(line.substr(space + 1)) != line.substr(0, space))
      return std::nullopt;
  }
  return hash;
}

}  // namespace

std::optional<std::string> sceneContentHash(const fs::path& file, bool allowOutside,
                                            const fs::path& cache) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const fs::path absolute = fs::absolute(file, error);
  const std::string key = fmt::format("scene 1 {} {}", allowOutside, absolute.string());
  const fs::path kept = cache / (hashOf(key) + ".txt");
  if (const auto text = readCached(kept, key))
    if (auto hash = hashFrom(*text)) return hash;

  std::string stamps = stampOf(absolute) + " " + absolute.string() + "\n", contents;
  bool fresh = isFresh(absolute);
  try {
    contents = hashOf(readTextFile(absolute)) + "\n";
    for (const auto& [name, path] : referencesOf(absolute, allowOutside)) {
      // The path where a missing file would be, so that its appearance is noticed.
      const fs::path place = path.empty() ? absolute.parent_path() / name : path;
      stamps += stampOf(place) + " " + place.string() + "\n";
      fresh = fresh || isFresh(place);
      contents += fmt::format("{} {}\n", path.empty() ? "none" : hashOf(readTextFile(path)), name);
    }
  } catch (const InputError&) {
    return std::nullopt;
  }
  const std::string hash = hashOf(contents);
  if (!fresh && absolute.string().find('\n') == std::string::npos)
    writeCached(kept, key, hash + "\n" + stamps);
  return hash;
}

std::optional<std::string> sceneContentHash(const fs::path& file, bool allowOutside) {
  return sceneContentHash(file, allowOutside, cacheRoot() / "scenes");
}

}  // namespace oitlab
