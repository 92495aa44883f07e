#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace oitlab {

/// The whole file, byte for byte, so also a binary file. Throws InputError with the file's name and
/// the system's message when it cannot be read.
std::string readTextFile(const std::filesystem::path& path);

/// Throws InputError with the file's name unless it is a regular file: reading a device may never
/// end, and opening a FIFO may wait forever.
void checkRegularFile(const std::filesystem::path& path);

/// Writes the whole file under a temporary name in the same folder and renames it. Thus a reader,
/// or the next run after a kill, sees the old file, the new file or none, but never a part of one.
/// The folder must exist. On failure it removes the temporary file and throws InputError with the
/// file's name.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace oitlab
