#pragma once

// What the files of the OBJ loader share; nobody else includes it.

#include <filesystem>
#include <map>
#include <string>

#include "scene/scene.h"

namespace oitlab {

/// The materials of an OBJ file's libraries, added to the scene as they are read.
class ObjMaterials {
 public:
  ObjMaterials(Scene& scene, std::filesystem::path folder)
      : scene_(scene), folder_(std::move(folder)) {}

  /// Reads a library; one that is missing or broken is a repair.
  void readLibrary(const std::string& name);

  /// The index of the material of that name; the plain default for unknown names (a repair, once a
  /// name) and for "".
  std::uint32_t find(const std::string& name);

 private:
  int readTextures(const std::filesystem::path& folder, const std::string& color,
                   const std::string& alpha);

  Scene& scene_;
  std::filesystem::path folder_;
  std::map<std::string, std::uint32_t> byName_;
  std::map<std::string, int> textures_;  // by both file names
};

}  // namespace oitlab
