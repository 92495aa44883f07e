#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace oitlab {

/// The whole file, byte for byte (so a binary file too). Throws InputError naming the file and what
/// the system says when it cannot be read.
std::string readTextFile(const std::filesystem::path& path);

/// Writes the whole file under a temporary name in the same folder and renames it, so that a
/// reader, or the next run after a kill, sees the old file, the new one or none, never half of one.
/// The folder must exist. Throws InputError naming the file; the temporary is removed then.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace oitlab
