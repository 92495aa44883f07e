#pragma once

#include "cpu_reference/cpu_renderer.h"
#include "support/gpu.h"

namespace oitlab::testing {

/// The comparison of an image with that of the CPU renderer.
struct Verdict {
  std::uint64_t wrong = 0;   ///< pixels without doubt that differ by more than the tolerance
  std::uint64_t edges = 0;   ///< differing pixels in doubt about edges or a cutoff
  std::uint64_t orders = 0;  ///< differing pixels in doubt about the order too
  double worst = 0.0;        ///< largest difference of a pixel without doubt
};

/// `hardware` also allows for the change of colours when a device snaps vertices.
Verdict judge(const Image& image, const CpuImage& truth, double tolerance, bool hardware = false);

/// The tolerance of a pixel without doubt. Measured on llvmpipe without textures: 0.001/255.
inline constexpr double tolerance = 2.0 / 255;

/// The tolerance with textures, because the filter is the device's. llvmpipe truncates the colours
/// between the end points of BC blocks: a step of 8-bit sRGB, which is 2.2/255 linear near white
/// (measured: 2.2/255). GPUs weight texels in steps of 1/256. Vulkan allows both. The level of
/// detail is computed by shade.glsl.
inline constexpr double textureTolerance = 4.0 / 255;

/// A method and its parameters.
struct Candidate {
  std::string method;
  std::map<std::string, std::string> parameters = {};
  bool hardware = false;  ///< the device's rasterizer makes its fragments
};

/// Expects the method's image to equal the CPU renderer's, except for pixels in doubt.
void expectTruth(const Candidate& candidate, const Scene& scene, const Camera& camera, int width,
                 int height, double allowed);

/// The same from the default view, with a tolerance that depends on the scene's textures.
void expectTruth(const Candidate& candidate, const Scene& scene, int width, int height);

/// A view inside objects, where triangles cross the near plane and reach behind the eye.
void expectTruthFromInside(const Candidate& candidate);

}  // namespace oitlab::testing
