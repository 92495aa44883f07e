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
#include "raster/triangles.glsl"

// Whether anything is interpolated.
#define INTERPOLATES (HAS_SMOOTH == 1 || HAS_TEXTURES == 1 || HAS_GRADIENTS == 1)

// What the fragments of a triangle need. The origin is the half-block's first sample.
struct Prepared {
  vec4 w;      // 1 / w: at the origin, per pixel right, per pixel down; PREPARED_* bits
  vec4 n0;     // normal of the corner that weighs 1 - b1 - b2; alpha cutoff
  vec4 color;  // of the material, times the vertex color if all corners have the same. If nothing is interpolated: shaded;
               // alpha is negative if the material cuts the triangle out
  vec4 range;  // smallest and largest 1 / w; primitive id
  // Where the scene interpolates:
  vec4 b1, b2;   // the weights over w: at the origin, per pixel right, per pixel down
  vec3 n1, n2;   // normals of the other corners less that of the first
  // Of triangles with textures or colors:
  vec4 uvs;           // texture coordinates of the first corner, difference of the second
  vec4 more;          // difference of the third corner; packed colors of the second and third
  uint firstColor;    // of the first corner, packed
};

struct Sample {
  float depth;  // reversed: larger is nearer
  uint id;
  vec4 color;  // straight, linear
};

// 1 / w at the half-block's first sample, and at a pixel of it. `precise`, because the order of fragments must be the
// same in every shader. Slivers have steep planes, so 1 / w is clamped to the range of the corners.
float originInvW(ShadeTriangle s, ivec2 corner) {
  const vec2 d = vec2(corner) + 0.5 - s.anchor;
  precise const float invW = fma(s.invWSlope.x, d.x, fma(s.invWSlope.y, d.y, s.invW));
  return invW;
}

float planeInvW(float origin, vec2 slope, float low, float high, vec2 pixel) {
  precise const float invW = fma(slope.x, pixel.x, fma(slope.y, pixel.y, origin));
  return clamp(invW, low, high);
}

vec2 boundsOfInvW(ShadeTriangle s) {
  return s.minInvW >= 0.0 ? vec2(s.minInvW, s.invW) : vec2(0.0, uintBitsToFloat(0x7f7fffffu));
}

float boundedInvW(float origin, ShadeTriangle s, vec2 pixel) {
  const vec2 bounds = boundsOfInvW(s);
  return planeInvW(origin, s.invWSlope, bounds.x, bounds.y, pixel);
}

// Reversed depth: near / distance. It is what fragments are ordered by and what the opaque depth is compared with, for
// every user of prepared triangles.
float depthOf(FrameBuffer frame, float invW) {
  precise const float depth = frame.c.viewProjection[3][2] * invW;
  return depth;
}

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
  uint bits = s.material << PREPARED_MATERIAL_SHIFT | material.atlas;
  p.firstColor = 0u;
  if (material.ignoreVertexAlpha != 0u) bits |= PREPARED_IGNORE_ALPHA;
  p.color = material.baseColor;
  p.uvs = p.more = vec4(0.0);
#if HAS_ATTRIBUTES
  if ((s.flags & TRIANGLE_COLORED) != 0u || material.atlas != 0u) {
    const uint c = s.flags >> TRIANGLE_CORNER_SHIFT;
    const uvec4 quad = mesh.quads.at[s.quad].corners;
    const vec4 v0 = mesh.vertices.at[pick(quad, c & 3u)].uvColorMaterial;
    const vec4 v1 = mesh.vertices.at[pick(quad, (c >> 2) & 3u)].uvColorMaterial;
    const vec4 v2 = mesh.vertices.at[pick(quad, (c >> 4) & 3u)].uvColorMaterial;
    const uvec3 colors = floatBitsToUint(vec3(v0.z, v1.z, v2.z));
    p.uvs = vec4(v0.xy, v1.xy - v0.xy);
    p.more = vec4(v2.xy - v0.xy, uintBitsToFloat(colors.yz));
    p.firstColor = colors.x;
    if (colors.y != colors.x || colors.z != colors.x) {
      bits |= PREPARED_COLORED;
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
  p.w = vec4(originInvW(s, corner), s.invWSlope, uintBitsToFloat(bits));
  p.n0 = vec4(n0, material.alphaCutoff);
  p.range = vec4(bounds, uintBitsToFloat(s.id), 0.0);
  p.b1 = vec4(b1, s.b1Slope, 0.0);
  p.b2 = vec4(b2, s.b2Slope, 0.0);
  p.n1 = n1;
  p.n2 = n2;
  return p;
}

Prepared prepare(Mesh mesh, FrameBuffer frame, uint slot, ivec2 corner) {
  return prepare(mesh, frame, loadShading(mesh, slot), corner);
}

float invWOf(Prepared p, vec2 pixel) { return planeInvW(p.w.x, p.w.yz, p.range.x, p.range.y, pixel); }
uint idOf(Prepared p) { return floatBitsToUint(p.range.z); }

// The color (straight, linear) of the fragment at `pixel` (0..7, 0..3) of the half-block. Returns false if the
// material cuts it out.
bool shadePrepared(FrameBuffer frame, Prepared p, vec2 pixel, float invW, out vec4 color) {
#if INTERPOLATES == 0
  color = p.color;
  return color.a >= 0.0;
#else
  const uint bits = floatBitsToUint(p.w.w);
  GpuMaterial material;
  material.baseColor = p.color;
  material.alphaCutoff = p.n0.w;
  material.atlas = HAS_TEXTURES == 1 ? bits & PREPARED_ATLAS : 0u;
  material.ignoreVertexAlpha = 1u;
  Surface s;
  s.color = vec4(1.0);  // contained in `baseColor`
  precise const float over1 = fma(p.b1.y, pixel.x, fma(p.b1.z, pixel.y, p.b1.x));
  precise const float over2 = fma(p.b2.y, pixel.x, fma(p.b2.z, pixel.y, p.b2.x));
  precise const float inverse = 1.0 / invW;
  precise const vec2 b = clamp(vec2(over1, over2) * inverse, 0.0, 1.0);
  const float b1 = b.x, b2 = b.y;
  precise const vec3 normal = fma(vec3(b1), p.n1, fma(vec3(b2), p.n2, p.n0.xyz));
  s.normal = normal;
#if HAS_TEXTURES
  if (material.atlas != 0u) {
    material.atlasRect = frame.c.materials.at[bits >> PREPARED_MATERIAL_SHIFT].atlasRect;
    const vec2 uv2 = p.more.xy;
    precise const vec2 uv = fma(vec2(b1), p.uvs.zw, fma(vec2(b2), uv2, p.uvs.xy));
    // uv / w is linear on the screen; the quotient rule gives the derivatives of uv.
    precise const vec2 dx = (p.uvs.xy * p.w.y + p.uvs.zw * p.b1.y + uv2 * p.b2.y - uv * p.w.y) * inverse;
    precise const vec2 dy = (p.uvs.xy * p.w.z + p.uvs.zw * p.b1.z + uv2 * p.b2.z - uv * p.w.z) * inverse;
    s.uv = uv;
    s.uvDx = dx;
    s.uvDy = dy;
  }
#endif
#if HAS_GRADIENTS
  if ((bits & PREPARED_COLORED) != 0u) {
    const vec4 c0 = unpackUnorm4x8(p.firstColor);
    precise const vec4 c1 = unpackUnorm4x8(floatBitsToUint(p.more.z)) - c0;
    precise const vec4 c2 = unpackUnorm4x8(floatBitsToUint(p.more.w)) - c0;
    precise const vec4 c = fma(vec4(b1), c1, fma(vec4(b2), c2, c0));
    material.baseColor.rgb *= c.rgb;
    if ((bits & PREPARED_IGNORE_ALPHA) == 0u) material.baseColor.a *= c.a;
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
  return p.n0.w > 0.0;
#endif
}

#endif
