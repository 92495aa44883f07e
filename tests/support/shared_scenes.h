#pragma once

#include <filesystem>

#include <gtest/gtest.h>

#include "util/paths.h"

namespace oitlab {

/// The folder of real scenes beside the source tree, or beside a bundle; not everybody has it.
inline std::filesystem::path sharedScenes() {
  return dataRoot() / ".." / "shared" / "scenes";
}

#define OITLAB_NEEDS_SHARED_SCENES()                            \
  if (!std::filesystem::is_directory(::oitlab::sharedScenes())) \
  GTEST_SKIP() << "no folder " << ::oitlab::sharedScenes().lexically_normal().string()

}  // namespace oitlab
