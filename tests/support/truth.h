#pragma once

#include "cpu_reference/cpu_renderer.h"
#include "support/gpu.h"

namespace oitlab::testing {

/// How an image compares with the CPU renderer's.
struct Verdict {
  std::uint64_t wrong = 0;   ///< pixels in no doubt that differ by more than the tolerance
  std::uint64_t edges = 0;   ///< pixels that do, in doubt about edges or a cutoff
  std::uint64_t orders = 0;  ///< pixels that do, in doubt about the order too
  double worst = 0.0;        ///< difference of a pixel in no doubt
};

/// `hardware`: allows for what devices make of the colours by snapping vertices, too.
Verdict judge(const Image& image, const CpuImage& truth, double tolerance, bool hardware = false);

/// Of a pixel in no doubt. Measured on llvmpipe: 0.001/255 where there is no texture.
inline constexpr double tolerance = 2.0 / 255;

/// Where textures are sampled, the filter is the device's: llvmpipe truncates the colours between
/// the end points of BC blocks, a step of 8-bit sRGB (2.2/255 linear near white; measured:
/// 2.2/255), and GPUs weigh texels in steps of 1/256. Vulkan allows both. The level of detail is
/// ours (shade.glsl).
inline constexpr double textureTolerance = 4.0 / 255;

/// A method, and what it is to be run with.
struct Candidate {
  std::string method;
  std::map<std::string, std::string> parameters = {};
  bool hardware = false;  ///< its fragments are made by the device's rasterizer
};

/// Expects the method's image to be the CPU renderer's, where that is in no doubt.
void expectTruth(const Candidate& candidate, const Scene& scene, const Camera& camera, int width,
                 int height, double allowed);

/// From the default view, with the tolerance that the scene's textures ask for.
void expectTruth(const Candidate& candidate, const Scene& scene, int width, int height);

/// Inside of things, where triangles cross the near plane and reach behind the eye.
void expectTruthFromInside(const Candidate& candidate);

}  // namespace oitlab::testing
