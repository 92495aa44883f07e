#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace oitlab {

/// The folder of a scene file, with the other files that the scene reads from it. A scene may come
/// from a stranger, so it may only name regular files inside its folder.
class SceneFolder {
 public:
  /// A file that the scene names, in the order in which the loader asks for them.
  struct Reference {
    std::string name;            ///< as in the scene file
    std::filesystem::path path;  ///< empty when there is no such file
  };

  /// `allowOutside`: absolute names, and names that lead out of the folder, are allowed.
  SceneFolder(const std::filesystem::path& sceneFile, bool allowOutside);

  /// The file that `name` means, relative to the folder; empty when there is none. Throws
  /// InputError when the name is absolute or leads out of the folder, and that is not allowed, and
  /// when there is something that is neither a file nor a folder: a device or a FIFO may never end.
  std::filesystem::path find(const std::string& name);

  /// Everything that find() was asked for, each name once.
  const std::vector<Reference>& references() const { return references_; }

 private:
  std::filesystem::path file_, folder_;
  bool allowOutside_;
  std::vector<Reference> references_;
};

}  // namespace oitlab
