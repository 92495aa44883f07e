#pragma once

#include "support/truth.h"

namespace oitlab::testing {

/// A method's parameters, as they are given on the command line.
using Given = std::map<std::string, std::string>;

/// `given` with source=compute.
Given onCompute(Given given = {});

/// Scenes with textures, opaque surfaces, colours, smooth normals, cutoffs, and none of these.
std::vector<Scene> variedScenes();

/// Pixels that differ by more than `allowed`: those whose fragments are beyond doubt, and the rest.
struct Differences {
  std::uint64_t certain = 0, inDoubt = 0;
};
Differences differencesOf(const Image& a, const Image& b, const CpuImage& truth, double allowed);

}  // namespace oitlab::testing
