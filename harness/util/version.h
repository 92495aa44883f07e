#pragma once

#include <string>

namespace oitlab {

/// The commit that this program was built from, in 12 digits; "-dirty" follows when files had
/// changes that it does not hold. "unknown" where the sources were not a git checkout.
std::string builtCommit();

/// A hash of the C++ source of harness/ and methods/ without the command line, 16 hexadecimal
/// digits: a program with another one may measure something else.
std::string builtSource();

/// CMake's name for how it was built: Release, Debug, RelWithDebInfo.
std::string buildType();

/// Version, commit and build type on one line.
std::string versionLine();

}  // namespace oitlab
