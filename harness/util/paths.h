#pragma once

#include <filesystem>

namespace oitlab {

/// The folder of the files that the program reads at run time (shaders/, experiments/). It is the
/// environment variable OITLAB_ROOT if that is set, else the source tree that the program was built
/// from, else the folder of the executable. Throws InputError when OITLAB_ROOT is not a folder.
std::filesystem::path dataRoot();

/// The folder for files that can be made again, such as compiled shaders. It is OITLAB_CACHE if
/// that is set, else oitlab/ in XDG_CACHE_HOME or ~/.cache, else in the system's temporary folder.
/// The function does not create it.
std::filesystem::path cacheRoot();

}  // namespace oitlab
