// The one shading of all methods: whoever rasterizes, the colour of a fragment is made here.
#ifndef OITLAB_SHADE_GLSL
#define OITLAB_SHADE_GLSL

#include "common/bindings.glsl"
#include "common/frame_types.h"

// The interpolated attributes of a fragment at its pixel's centre.
struct Surface {
  vec3 normal;  // world space, any length
  vec2 uv;
  vec2 uvDx;    // analytic derivative of uv to the right neighbour, per pixel
  vec2 uvDy;    // and to the lower one
  vec4 color;   // vertex colour, linear
};

// Fixed light, so that scenes look alike under every method: a hemisphere around this direction
// (wrapped diffuse, never black, the same from both sides of an open surface).
const vec3 toLight = vec3(0.3999, 0.8142, 0.4206);  // unit length
const float ambient = 0.2;

// The level of detail as Vulkan defines it for isotropic filtering. Worked out here, because what
// devices make of gradients differs: Vulkan lets them approximate, and deep
// foliage shows it.
float levelOfDetail(vec2 dx, vec2 dy, vec2 atlasSize) {
  const vec2 texelsX = dx * atlasSize, texelsY = dy * atlasSize;
  return 0.5 * log2(max(max(dot(texelsX, texelsX), dot(texelsY, texelsY)), 1e-12));
}

vec4 sampleTexture(GpuMaterial material, Surface s) {
  // Textures repeat inside an atlas, so the wrap is ours; the gradients are of the unwrapped uv and
  // have no seam where fract() jumps.
  const vec2 uv = material.atlasRect.xy + fract(s.uv) * material.atlasRect.zw;
  const vec2 dx = s.uvDx * material.atlasRect.zw;
  const vec2 dy = s.uvDy * material.atlasRect.zw;
  if (material.atlas == 1u) {
    const float level = levelOfDetail(dx, dy, vec2(textureSize(opaqueAtlas, 0)));
    return vec4(textureLod(opaqueAtlas, uv, level).rgb, 1.0);
  }
  const float level = levelOfDetail(dx, dy, vec2(textureSize(transparentAtlas, 0)));
  return textureLod(transparentAtlas, uv, level);
}

// False where the material's cutoff removes the fragment. `color` is linear, not premultiplied, its
// alpha in [0, 1].
bool shade(GpuMaterial material, Surface s, out vec4 color) {
  color = material.baseColor;
  color.rgb *= s.color.rgb;
  if (material.ignoreVertexAlpha == 0u) color.a *= s.color.a;
  if (material.atlas != 0u) color *= sampleTexture(material, s);
  // The cutoff is that of the final alpha: an opacity override has scaled it (scene/scene.h).
  if (color.a < material.alphaCutoff) return false;
  const float wrapped = 0.5 + 0.5 * dot(normalize(s.normal), toLight);
  color.rgb *= mix(ambient, 1.0, wrapped);
  color.a = clamp(color.a, 0.0, 1.0);
  return true;
}

#endif
