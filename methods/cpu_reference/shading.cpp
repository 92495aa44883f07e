#include "shading.h"

#include <algorithm>
#include <cmath>

namespace oitlab::cpu_reference {
namespace {

// As in shade.glsl.
const glm::dvec3 toLight(0.3999, 0.8142, 0.4206);
constexpr double ambient = 0.2;

// The error of alpha on a device: BC3 interpolates it in steps of 1/255, and texels are weighted in
// steps of 1/256 in each direction and between levels. Together these are up to 4/256, and a little
// for the shader's log2.
constexpr double cutoffDoubt = 0.02;

glm::dvec4 unpackColor(std::uint32_t packed) {
  glm::dvec4 color;
  for (int i = 0; i < 4; ++i) color[i] = double((packed >> (8 * i)) & 255u) / 255.0;
  return color;
}

}  // namespace

Shading::Shading(const Scene& scene, const SceneAtlases& atlases)
    : scene_(scene), placements_(atlases.ofMaterial) {
  const Atlas* const both[] = {&atlases.opaque, &atlases.transparent};
  for (int i = 0; i < 2; ++i)
    for (std::size_t l = 0; l < both[i]->levels.size(); ++l)
      levels_[i].push_back(
          {both[i]->levels[l].width, both[i]->levels[l].height, decodeAtlasLevel(*both[i], l)});
  for (int code = 0; code < 256; ++code) {
    const double c = code / 255.0;  // IEC 61966-2-1
    linear_[code] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
}

Shaded Shading::shade(const glm::uvec3& triangle, const Hit& hit) const {
  const Vertex* const corners[3] = {&scene_.vertices[triangle.x], &scene_.vertices[triangle.y],
                                    &scene_.vertices[triangle.z]};
  glm::dvec3 normal(0.0);
  glm::dvec4 color(0.0);
  glm::dvec2 uv(0.0), uvDx(0.0), uvDy(0.0);
  for (int i = 0; i < 3; ++i) {
    normal += hit.weight[i] * glm::dvec3(unpackNormal(corners[i]->normal));
    color += hit.weight[i] * unpackColor(corners[i]->color);
    uv += hit.weight[i] * glm::dvec2(corners[i]->uv);
    uvDx += hit.weightDx[i] * glm::dvec2(corners[i]->uv);
    uvDy += hit.weightDy[i] * glm::dvec2(corners[i]->uv);
  }

  const Material& material = scene_.materials[corners[0]->material];
  const AtlasPlacement& place = placements_[corners[0]->material];
  if (material.ignoreVertexAlpha) color.a = 1.0;
  color *= glm::dvec4(material.baseColor);
  if (place.atlas != 0) {
    const glm::dvec2 offset(place.rect.x, place.rect.y), extent(place.rect.z, place.rect.w);
    color *= sample(levels_[place.atlas - 1], offset + glm::fract(uv) * extent, uvDx * extent,
                    uvDy * extent);
  }
  const double wrapped = 0.5 + 0.5 * glm::dot(glm::normalize(normal), toLight);
  Shaded result;
  result.discarded = color.a < double(material.alphaCutoff);
  result.nearCutoff =
      material.alphaCutoff > 0.0f && std::abs(color.a - double(material.alphaCutoff)) < cutoffDoubt;
  result.color = glm::dvec4(glm::dvec3(color) * glm::mix(ambient, 1.0, wrapped),
                            std::clamp(color.a, 0.0, 1.0));
  return result;
}

// Vulkan 1.3, 16.5.7 and 16.5.8, isotropic: the level is log2 of the longer gradient in texels,
// clamped to the existing levels. Two levels are mixed by its fraction.
glm::dvec4 Shading::sample(const Levels& levels, glm::dvec2 uv, glm::dvec2 dx,
                           glm::dvec2 dy) const {
  const glm::dvec2 size(levels[0].width, levels[0].height);
  const double longer = std::max(glm::length(dx * size), glm::length(dy * size));
  const double last = double(levels.size() - 1);
  const double lod = longer > 1.0 ? std::min(std::log2(longer), last) : 0.0;
  const auto fine = std::size_t(lod);
  const double fraction = lod - double(fine);
  const glm::dvec4 texel = bilinear(levels[fine], uv);
  return fraction > 0.0 ? glm::mix(texel, bilinear(levels[fine + 1], uv), fraction) : texel;
}

// Colours are decoded before they are mixed, as sRGB formats demand.
glm::dvec4 Shading::bilinear(const Texels& level, glm::dvec2 uv) const {
  const glm::dvec2 at = uv * glm::dvec2(level.width, level.height) - 0.5;
  const glm::dvec2 corner = glm::floor(at), t = at - corner;
  const auto texel = [&](int x, int y) {
    x = std::clamp(int(corner.x) + x, 0, level.width - 1);
    y = std::clamp(int(corner.y) + y, 0, level.height - 1);
    const std::uint8_t* rgba =
        &level.rgba[4 * (std::size_t(y) * std::size_t(level.width) + std::size_t(x))];
    return glm::dvec4(linear_[rgba[0]], linear_[rgba[1]], linear_[rgba[2]], rgba[3] / 255.0);
  };
  return glm::mix(glm::mix(texel(0, 0), texel(1, 0), t.x), glm::mix(texel(0, 1), texel(1, 1), t.x),
                  t.y);
}

}  // namespace oitlab::cpu_reference
