// The one shading of all methods: whoever rasterizes, the colour of a fragment is made here. `precise`,
// and with multiply-adds written as such: compilers that choose for themselves where to fuse them choose
// differently from program to program (NVIDIA's 580.159.04 did), and images would differ in the last bit.
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
  precise const vec2 texelsX = dx * atlasSize, texelsY = dy * atlasSize;
  precise const float right = fma(texelsX.x, texelsX.x, texelsX.y * texelsX.y);
  precise const float down = fma(texelsY.x, texelsY.x, texelsY.y * texelsY.y);
  return 0.5 * log2(max(max(right, down), 1e-12));
}

vec4 sampleTexture(GpuMaterial material, Surface s) {
  // Textures repeat inside an atlas, so the wrap is ours; the gradients are of the unwrapped uv and
  // have no seam where fract() jumps.
  precise const vec2 uv = fma(fract(s.uv), material.atlasRect.zw, material.atlasRect.xy);
  precise const vec2 dx = s.uvDx * material.atlasRect.zw;
  precise const vec2 dy = s.uvDy * material.atlasRect.zw;
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
  const vec3 n = s.normal;
  precise const float lengthSquared = fma(n.x, n.x, fma(n.y, n.y, n.z * n.z));
  precise const float towards = fma(n.x, toLight.x, fma(n.y, toLight.y, n.z * toLight.z));
  precise const float cosine = towards * inversesqrt(lengthSquared);
  precise const float light = fma(1.0 - ambient, fma(0.5, cosine, 0.5), ambient);
  precise const vec3 lit = color.rgb * light;
  color.rgb = lit;
  color.a = clamp(color.a, 0.0, 1.0);
  return true;
}

#endif
