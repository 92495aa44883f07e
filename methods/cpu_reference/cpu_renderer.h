#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "image/image.h"
#include "scene/atlas.h"
#include "scene/scene.h"

namespace oitlab {

/// Reasons why a pixel may look different in float32 and still be right: bits of CpuImage::doubts.
/// Only visible fragments count, not those behind opaque ones.
namespace doubt {
/// An edge or the near plane is within 1/256 pixel of the centre. Devices snap vertices to such a
/// grid, so they may have a fragment more or less.
inline constexpr std::uint8_t edge = 1;
/// Two surfaces are so close in depth that float32 may order them the other way, and the image
/// would differ by 1/255. Copies of one triangle do not count: they are ordered by primitive id.
inline constexpr std::uint8_t depthOrder = 2;
/// A fragment's alpha is within 0.02 of its material's cutoff. Devices filter textures less
/// exactly.
inline constexpr std::uint8_t cutoff = 4;
}  // namespace doubt

/// The result of renderOnCpu(): width * height elements each, rows top to bottom.
struct CpuImage {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> color;         ///< linear, over the opaque background: alpha is 1
  std::vector<std::uint32_t> fragments;  ///< number of transparent fragments that were blended
  std::vector<std::uint8_t> doubts;      ///< bits of namespace doubt
  /// How much the colour may differ on a device that snaps vertices to 1/256 pixel, because it
  /// interpolates over triangles that are moved that much. It matters for small triangles and at
  /// grazing angles.
  std::vector<float> snapping;

  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
  }
  std::uint64_t fragmentCount() const;
  std::uint64_t coveredPixels() const;         ///< pixels with at least one transparent fragment
  std::uint32_t maxFragmentsPerPixel() const;  ///< of any pixel
  std::uint64_t pixelsInDoubt(std::uint8_t bits) const;  ///< pixels with any of the bits
  Image toImage() const;
};

/// The image that every exact method must make, in double precision and without a device: the
/// fragments of shaders/common, sorted by depth and primitive id and blended front to back.
/// Coverage is exact too. Runs on all cores. Sides are from 1 to 2^14 pixels. `atlases` are those
/// of the scene.
CpuImage renderOnCpu(const Scene& scene, const SceneAtlases& atlases, const Camera& camera,
                     int width, int height);
CpuImage renderOnCpu(const Scene& scene, const Camera& camera, int width, int height);

}  // namespace oitlab
