#pragma once

#include <string>

namespace oitlab {

/// The commit that this program was built from, in 12 digits; "-dirty" follows when files had
/// changes that it does not hold. "unknown" where the sources were not a git checkout.
std::string builtCommit();

/// CMake's name for how it was built: Release, Debug, RelWithDebInfo.
std::string buildType();

/// Version, commit and build type on one line.
std::string versionLine();

}  // namespace oitlab
