#pragma once

// Shared by the files of the OBJ loader. No other file includes it.

#include <filesystem>
#include <map>
#include <string>

#include "scene/scene.h"

namespace oitlab {

/// The materials of an OBJ file's libraries. They are added to the scene when they are read.
class ObjMaterials {
 public:
  ObjMaterials(Scene& scene, std::filesystem::path folder)
      : scene_(scene), folder_(std::move(folder)) {}

  /// Reads a library. One that is missing or invalid is a repair.
  void readLibrary(const std::string& name);

  /// The index of the material of that name. For "" and for unknown names it is the default
  /// material; an unknown name is a repair, counted once.
  std::uint32_t find(const std::string& name);

 private:
  int readTextures(const std::filesystem::path& folder, const std::string& color,
                   const std::string& alpha);

  Scene& scene_;
  std::filesystem::path folder_;
  std::map<std::string, std::uint32_t> byName_;
  std::map<std::string, int> textures_;  // by the names of both files
};

}  // namespace oitlab
