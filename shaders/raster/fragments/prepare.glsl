// Sample shading (LucidRaster, section 2, phase 3): a triangle prepared for one half-block, and its fragment at one
// pixel. The includer defines what raster/scene_defines.h lists: HAS_OPAQUE, HAS_TEXTURES, HAS_GRADIENTS (the corners of some triangle differ
// in color), HAS_ATTRIBUTES (textures or colors) and HAS_SMOOTH (the corners of some triangle differ in normal). Code
// for what a scene does not have is left out: on GPUs it would take registers, and llvmpipe executes branches that no
// lane takes.
#ifndef OITLAB_RASTER_PREPARE_GLSL
#define OITLAB_RASTER_PREPARE_GLSL

#include "common/normal.glsl"
#include "common/shade.glsl"
#include "raster/blocks/block_types.h"
#include "raster/depth.glsl"
#include "raster/triangles.glsl"

// Whether anything is interpolated.
#define INTERPOLATES (HAS_SMOOTH == 1 || HAS_TEXTURES == 1 || HAS_GRADIENTS == 1)

// What the fragments of a triangle need. Functions over the half-block are given by their value at its first sample,
// and their slope per pixel to the right and per pixel down. prepared.glsl packs this where it is stored.
struct Prepared {
  float invW;  // 1 / w
  vec2 invWSlope;
  float minInvW, maxInvW;  // of the corners
  uint id;                 // primitive id
  uint bits;               // PREPARED_*
  vec4 color;  // of the material, times the vertex color if all corners have the same. If nothing is interpolated: shaded;
               // alpha is negative if the material cuts the triangle out
  // Where the scene interpolates:
  float alphaCutoff;
  float b1, b2;  // weights of the second and third corner, over w
  vec2 b1Slope, b2Slope;
  vec3 normal, normal1, normal2;  // of the first corner; differences of the second and third from it
  // Of triangles with textures or colors:
  vec2 uv, uv1, uv2;   // likewise
  uvec3 vertexColors;  // of the three corners, packed
};

struct Sample {
  float depth;  // reversed: larger is nearer
  uint id;
  vec4 color;  // straight, linear
};

// Whether a fragment is behind the opaque depth of its pixel.
bool isHidden(float depth, float opaqueDepthThere) {
#if HAS_OPAQUE
  return depth < opaqueDepthThere;
#else
  return false;
#endif
}

float opaqueDepthAt(FrameBuffer frame, ivec2 place) {
#if HAS_OPAQUE
  return texelFetch(opaqueDepth, min(place, ivec2(frame.c.size) - 1), 0).r;
#else
  return 0.0;
#endif
}

// Bits of the material, below its index in the same word.
#define PREPARED_ATLAS 3u
#define PREPARED_IGNORE_ALPHA 4u
#define PREPARED_COLORED 8u  // the corners differ in color
#define PREPARED_MATERIAL_SHIFT 4

uint pick(uvec4 v, uint i) { return i == 0u ? v.x : i == 1u ? v.y : i == 2u ? v.z : v.w; }

Prepared prepare(Mesh mesh, FrameBuffer frame, ShadeTriangle s, ivec2 corner) {
  const GpuMaterial material = frame.c.materials.at[s.material];
  const vec2 d = vec2(corner) + 0.5 - s.anchor;
  const vec2 bounds = boundsOfInvW(s);
  precise const float b1 = fma(s.b1Slope.x, d.x, fma(s.b1Slope.y, d.y, s.weights.x));
  precise const float b2 = fma(s.b2Slope.x, d.x, fma(s.b2Slope.y, d.y, s.weights.y));
  const vec3 n0 = unpackNormal(s.normals[0]);
  precise const vec3 n1 = unpackNormal(s.normals[1]) - n0;
  precise const vec3 n2 = unpackNormal(s.normals[2]) - n0;
  Prepared p;
  p.bits = s.material << PREPARED_MATERIAL_SHIFT | material.atlas;
  if (material.ignoreVertexAlpha != 0u) p.bits |= PREPARED_IGNORE_ALPHA;
  p.color = material.baseColor;
  p.uv = p.uv1 = p.uv2 = vec2(0.0);
  p.vertexColors = uvec3(0u);
#if HAS_ATTRIBUTES
  if ((s.flags & TRIANGLE_COLORED) != 0u || material.atlas != 0u) {
    const uint c = s.flags >> TRIANGLE_CORNER_SHIFT;
    const uvec4 quad = mesh.quads.at[s.quad].corners;
    const vec4 v0 = mesh.vertices.at[pick(quad, c & 3u)].uvColorMaterial;
    const vec4 v1 = mesh.vertices.at[pick(quad, (c >> 2) & 3u)].uvColorMaterial;
    const vec4 v2 = mesh.vertices.at[pick(quad, (c >> 4) & 3u)].uvColorMaterial;
    const uvec3 colors = floatBitsToUint(vec3(v0.z, v1.z, v2.z));
    p.uv = v0.xy;
    p.uv1 = v1.xy - v0.xy;
    p.uv2 = v2.xy - v0.xy;
    p.vertexColors = colors;
    if (colors.y != colors.x || colors.z != colors.x) {
      p.bits |= PREPARED_COLORED;
    } else {
      const vec4 color = unpackUnorm4x8(colors.x);
      p.color.rgb *= color.rgb;
      if (material.ignoreVertexAlpha == 0u) p.color.a *= color.a;
    }
  }
#endif
#if INTERPOLATES == 0
  // All fragments of the triangle have one color.
  GpuMaterial flat_ = material;
  flat_.baseColor = p.color;
  flat_.atlas = 0u;
  flat_.ignoreVertexAlpha = 1u;
  Surface surface;
  surface.normal = n0;
  surface.color = vec4(1.0);  // contained in `baseColor`
  vec4 color;
  p.color = shade(flat_, surface, color) ? color : vec4(-1.0);
#endif
  p.invW = originInvW(s, corner);
  p.invWSlope = s.invWSlope;
  p.minInvW = bounds.x;
  p.maxInvW = bounds.y;
  p.id = s.id;
  p.alphaCutoff = material.alphaCutoff;
  p.b1 = b1;
  p.b2 = b2;
  p.b1Slope = s.b1Slope;
  p.b2Slope = s.b2Slope;
  p.normal = n0;
  p.normal1 = n1;
  p.normal2 = n2;
  return p;
}

Prepared prepare(Mesh mesh, FrameBuffer frame, uint slot, ivec2 corner) {
  return prepare(mesh, frame, loadShading(mesh, slot), corner);
}

float invWOf(Prepared p, vec2 pixel) { return planeInvW(p.invW, p.invWSlope, p.minInvW, p.maxInvW, pixel); }

// The color (straight, linear) of the fragment at `pixel` (0..7, 0..3) of the half-block. Returns false if the
// material cuts it out.
bool shadePrepared(FrameBuffer frame, Prepared p, vec2 pixel, float invW, out vec4 color) {
#if INTERPOLATES == 0
  color = p.color;
  return color.a >= 0.0;
#else
  GpuMaterial material;
  material.baseColor = p.color;
  material.alphaCutoff = p.alphaCutoff;
  material.atlas = HAS_TEXTURES == 1 ? p.bits & PREPARED_ATLAS : 0u;
  material.ignoreVertexAlpha = 1u;
  Surface s;
  s.color = vec4(1.0);  // contained in `baseColor`
  precise const float over1 = fma(p.b1Slope.x, pixel.x, fma(p.b1Slope.y, pixel.y, p.b1));
  precise const float over2 = fma(p.b2Slope.x, pixel.x, fma(p.b2Slope.y, pixel.y, p.b2));
  precise const float inverse = 1.0 / invW;
  precise const vec2 b = clamp(vec2(over1, over2) * inverse, 0.0, 1.0);
  const float b1 = b.x, b2 = b.y;
  precise const vec3 normal = fma(vec3(b1), p.normal1, fma(vec3(b2), p.normal2, p.normal));
  s.normal = normal;
#if HAS_TEXTURES
  if (material.atlas != 0u) {
    material.atlasRect = frame.c.materials.at[p.bits >> PREPARED_MATERIAL_SHIFT].atlasRect;
    precise const vec2 uv = fma(vec2(b1), p.uv1, fma(vec2(b2), p.uv2, p.uv));
    // uv / w is linear on the screen; the quotient rule gives the derivatives of uv.
    const vec2 w = p.invWSlope, s1 = p.b1Slope, s2 = p.b2Slope;
    precise const vec2 dx = (p.uv * w.x + p.uv1 * s1.x + p.uv2 * s2.x - uv * w.x) * inverse;
    precise const vec2 dy = (p.uv * w.y + p.uv1 * s1.y + p.uv2 * s2.y - uv * w.y) * inverse;
    s.uv = uv;
    s.uvDx = dx;
    s.uvDy = dy;
  }
#endif
#if HAS_GRADIENTS
  if ((p.bits & PREPARED_COLORED) != 0u) {
    const vec4 c0 = unpackUnorm4x8(p.vertexColors.x);
    precise const vec4 c1 = unpackUnorm4x8(p.vertexColors.y) - c0;
    precise const vec4 c2 = unpackUnorm4x8(p.vertexColors.z) - c0;
    precise const vec4 c = fma(vec4(b1), c1, fma(vec4(b2), c2, c0));
    material.baseColor.rgb *= c.rgb;
    if ((p.bits & PREPARED_IGNORE_ALPHA) == 0u) material.baseColor.a *= c.a;
  }
#endif
  return shade(material, s, color);
#endif
}

// Whether shadePrepared() can return false.
bool hasCutoff(Prepared p) {
#if INTERPOLATES == 0
  return p.color.a < 0.0;
#else
  return p.alphaCutoff > 0.0;
#endif
}

#endif
