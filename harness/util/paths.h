#pragma once

#include <filesystem>

namespace oitlab {

/// The folder that holds what the program reads at run time (shaders/, experiments/): the
/// environment variable OITLAB_ROOT if set, else the source tree that the program was built from,
/// else the folder of the executable. Throws InputError when OITLAB_ROOT is not a folder.
std::filesystem::path dataRoot();

/// Where things may be kept that can be made again (compiled shaders): OITLAB_CACHE if set, else
/// oitlab/ in XDG_CACHE_HOME or ~/.cache, else in the system's temporary folder. Not made here.
std::filesystem::path cacheRoot();

}  // namespace oitlab
