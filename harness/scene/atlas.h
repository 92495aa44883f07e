#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace oitlab {

/// Many textures in one block-compressed image with mip levels. oitlab uses atlases because not
/// every device has descriptor indexing. Colours are sRGB-encoded (formats BC1_RGB_SRGB and
/// BC3_SRGB), alpha is linear and not premultiplied.
///
/// Each texture has a border of its own repeated texels, which is at least one texel wide at the
/// last level. Therefore bilinear and trilinear filtering at the atlas coordinate
///     rect.offset + fract(uv) * rect.extent
/// repeats the texture and never reads a neighbour. The derivatives must be those of `uv` times
/// rect.extent, not those of the fraction, and the level at most levels.size() - 1. Anisotropic
/// filtering would reach beyond the border.
struct Atlas {
  struct Level {
    int width = 0;  ///< texels, a multiple of 4
    int height = 0;
    std::vector<std::uint8_t> blocks;  ///< rows of 4x4 blocks of 8 (BC1) or 16 (BC3) bytes
  };

  int width = 0;  ///< texels of level 0; 0 when there is no texture
  int height = 0;
  bool alpha = false;  ///< true: BC3, false: BC1
  std::vector<Level> levels;
};

/// Where a material's texture is, in the form of GpuMaterial.
struct AtlasPlacement {
  std::uint32_t atlas = 0;  ///< 0: no texture, 1: SceneAtlases::opaque, 2: ::transparent
  glm::vec4 rect{0.0f};     ///< offset.xy and extent.zw in atlas uv
};

struct SceneAtlases {
  Atlas opaque;       ///< textures that are drawn without alpha: BC1 samples as alpha 1
  Atlas transparent;  ///< textures with alpha, of materials that do not ignore it
  std::vector<AtlasPlacement> ofMaterial;  ///< one per material of the scene
  std::size_t texturesHalved = 0;          ///< textures that were halved at least once to fit
};

/// Builds both atlases, on all cores. A side has at most `maxSide` texels (a positive multiple of
/// 128). If the textures do not fit, the largest are halved until they do. Throws InputError when
/// there are too many textures for that.
SceneAtlases buildAtlases(const Scene& scene, int maxSide = 16384);

/// A level as RGBA8, colours still sRGB-encoded: for devices without BC formats, and for tests.
std::vector<std::uint8_t> decodeAtlasLevel(const Atlas& atlas, std::size_t level);

}  // namespace oitlab
