#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "image/image.h"
#include "scene/atlas.h"
#include "scene/scene.h"

namespace oitlab {

/// Why a pixel may rightly look different in float32: bits of CpuImage::doubts. Only what is
/// visible counts: fragments behind opaque ones raise none.
namespace doubt {
/// An edge (or the near plane) comes within 1/256 pixel of the centre: devices snap vertices to
/// such a grid, so a fragment more or less is right too.
inline constexpr std::uint8_t edge = 1;
/// Two surfaces are so close in depth that float32 may order them the other way, and it would show
/// (by 1/255). Copies of one triangle raise none: they are ordered by primitive id.
inline constexpr std::uint8_t depthOrder = 2;
/// A fragment's alpha is within 0.02 of its material's cutoff: devices filter textures less
/// exactly.
inline constexpr std::uint8_t cutoff = 4;
}  // namespace doubt

/// What renderOnCpu() makes; width * height of each, rows top to bottom.
struct CpuImage {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> color;         ///< linear, over the opaque background: alpha is 1
  std::vector<std::uint32_t> fragments;  ///< transparent ones that were blended
  std::vector<std::uint8_t> doubts;      ///< bits of namespace doubt
  /// What a device that snaps vertices to 1/256 pixel may make of the colour, by interpolating over
  /// triangles that are moved or bent so much: more than nothing where they are small or seen at
  /// grazing angles.
  std::vector<float> snapping;

  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
  }
  std::uint64_t fragmentCount() const;
  std::uint64_t coveredPixels() const;                   ///< with at least one transparent fragment
  std::uint32_t maxFragmentsPerPixel() const;            ///< of any pixel
  std::uint64_t pixelsInDoubt(std::uint8_t bits) const;  ///< with any of the bits
  Image toImage() const;
};

/// The picture that every exact method has to make, in double precision, without any device: the
/// fragments of shaders/common, sorted by depth and primitive id, blended front to back. Exact in
/// coverage, too. On all cores; sides from 1 to 2^14 pixels. `atlases` are the scene's.
CpuImage renderOnCpu(const Scene& scene, const SceneAtlases& atlases, const Camera& camera,
                     int width, int height);
CpuImage renderOnCpu(const Scene& scene, const Camera& camera, int width, int height);

}  // namespace oitlab
