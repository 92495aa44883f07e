#pragma once

// Shared by the files of the OBJ loader. No other file includes it.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tiny_obj_loader.h>

#include "scene/import/budget.h"
#include "scene/import/scene_folder.h"
#include "scene/scene.h"

namespace oitlab {

/// A file of materials.
struct ObjLibrary {
  std::filesystem::path name;  ///< relative to the scene's folder
  std::vector<tinyobj::material_t> materials;
  std::map<std::string, int> indices;  ///< into materials, by name
  bool found = false, hasErrors = false;

  /// The name, relative to the scene's folder, of a file that this library names; empty for "".
  std::string beside(const std::string& file) const;
};

/// Reads the library that an OBJ file in `folder` names. Throws what SceneFolder::find() throws.
ObjLibrary readObjLibrary(const std::string& name, SceneFolder& folder);

/// The materials of an OBJ file's libraries. They are added to the scene when they are read.
class ObjMaterials {
 public:
  /// All must outlive this.
  ObjMaterials(Scene& scene, SceneFolder& folder, SceneBudget& budget)
      : scene_(scene), folder_(folder), budget_(budget) {}

  /// Reads a library. One that is missing or invalid is a repair.
  void readLibrary(const std::string& name);

  /// The index of the material of that name. For "" and for unknown names it is the default
  /// material; an unknown name is a repair, counted once.
  std::uint32_t find(const std::string& name);

 private:
  int readTextures(const std::string& color, const std::string& alpha);

  Scene& scene_;
  SceneFolder& folder_;
  SceneBudget& budget_;
  std::map<std::string, std::uint32_t> byName_;
  std::map<std::string, int> textures_;  // by the names of both files
};

}  // namespace oitlab
