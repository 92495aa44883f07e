#pragma once

#include <filesystem>

#include <gtest/gtest.h>

namespace oitlab {

/// The folder of real scenes beside the source tree; not everybody has it.
inline std::filesystem::path sharedScenes() {
  return std::filesystem::path(OITLAB_TEST_SOURCE_DIR) / ".." / "shared" / "scenes";
}

#define OITLAB_NEEDS_SHARED_SCENES()                            \
  if (!std::filesystem::is_directory(::oitlab::sharedScenes())) \
  GTEST_SKIP() << "no ../shared/scenes beside the source tree"

}  // namespace oitlab
