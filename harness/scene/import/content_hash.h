#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace oitlab {

/// A hash of the contents of a scene file and of all files that it names: buffers, material
/// libraries and textures. 32 hex digits. Two files of one name and size differ in it; a copy in
/// another folder does not. Empty when `file` is not a regular file or cannot be read (generated
/// scenes, say). A file that cannot be loaded has the hash of its own bytes.
///
/// Hashes are kept in the cache folder. A kept one is used as long as path, inode, size and
/// modification time of all files are the same. `allowOutside` as for loadScene().
std::optional<std::string> sceneContentHash(const std::filesystem::path& file,
                                            bool allowOutside = false);

/// The same with the hashes in `cache`.
std::optional<std::string> sceneContentHash(const std::filesystem::path& file, bool allowOutside,
                                            const std::filesystem::path& cache);

}  // namespace oitlab
