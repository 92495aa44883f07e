#include "fuzz/targets.h"

#include <unistd.h>

#include "util/error.h"

namespace oitlab {
namespace {

struct Folder {
  Folder()
      : path(std::filesystem::temp_directory_path() /
             ("oitlab_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::filesystem::path path;
};

}  // namespace

const std::filesystem::path& fuzzFolder() {
  static const Folder folder;
  return folder.path;
}

void parseOrRefuse(const std::function<void()>& parse) {
  try {
    parse();
  } catch (const InputError&) {
  }
}

const std::map<std::string, std::function<void(std::string_view)>>& fuzzTargets() {
  static const std::map<std::string, std::function<void(std::string_view)>> targets = {
      {"gltf", fuzzGltf},
      {"obj", fuzzObj},
      {"texture", fuzzTexture},
      {"png", fuzzPng},
      {"exr", fuzzExr},
      {"experiment", fuzzExperiment},
      {"cell", fuzzCell},
      {"spirv_cache", fuzzSpirvCache},
      {"quad_cache", fuzzQuadCache}};
  return targets;
}

}  // namespace oitlab
