#include "util/version.h"

#include "commit.h"

// CMake gives OITLAB_VERSION and OITLAB_BUILD_TYPE to this file alone (cmake/provenance.cmake): a
// new commit compiles nothing else.
namespace oitlab {

std::string builtCommit() {
  return OITLAB_COMMIT;
}

std::string builtSource() {
  return OITLAB_SOURCE;
}

std::string buildType() {
  return OITLAB_BUILD_TYPE;
}

std::string versionLine() {
  return "oitlab " OITLAB_VERSION ", commit " OITLAB_COMMIT ", " OITLAB_BUILD_TYPE;
}

}  // namespace oitlab
