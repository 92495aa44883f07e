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

/// Expects that frames of the two sources differ by more than `tolerance` only where fragments are
/// in doubt, and there in less than 0.1% of the chances: a device may take a sample within 1/256
/// pixel of an edge to the other side of it, and depths round differently. As in truth.cpp, the
/// chances are fragments in scenes of many layers. `what` names the case.
void expectEqualButAtEdges(const RenderFixture::Result& hardware,
                           const RenderFixture::Result& compute, const CpuImage& truth,
                           const std::string& what);

}  // namespace oitlab::testing
