#pragma once

#include <filesystem>

#include <gtest/gtest.h>

#include "util/paths.h"

namespace oitlab {

/// The folder of real scenes beside the source tree or beside a bundle. Not every machine has it.
inline std::filesystem::path sharedScenes() {
  return dataRoot() / ".." / "shared" / "scenes";
}

/// Whether the library is there. Checks the manifest, because a folder with a few scenes is not the
/// library.
#define OITLAB_NEEDS_SHARED_SCENES()                                        \
  if (!std::filesystem::exists(::oitlab::sharedScenes() / "manifest.json")) \
  GTEST_SKIP() << "no library of scenes in " << ::oitlab::sharedScenes().lexically_normal().string()

}  // namespace oitlab
