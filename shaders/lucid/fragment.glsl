// Sample shading (section 2, phase 3): a triangle made ready for one half-block, and its fragment at
// one pixel. The including shader defines SUBGROUP_SIZE, TEAMS and HAS_OPAQUE and declares `push`.
#ifndef OITLAB_LUCID_FRAGMENT_GLSL
#define OITLAB_LUCID_FRAGMENT_GLSL

#include "common/normal.glsl"
#include "common/shade.glsl"
#include "lucid/lucid_types.h"
#include "raster/records.glsl"

// What a triangle's fragments need, with the half-block's first sample as the origin: made once for
// all of them, by one lane, and read by all lanes. 9 words of 16 bytes, so that the accesses of
// neighbouring lanes fall into different banks of shared memory.
#define PREPARED_WORDS 9u
shared vec4 prepared[TEAMS * SUBGROUP_SIZE * PREPARED_WORDS];

struct Fragment {
  float invW;  // 1 / distance: what depth is near times. Larger is nearer
  uint id;
  vec4 color;  // straight, linear
};

// 1 / w at the half-block's first sample, and at a pixel of it. `precise`: the order of fragments must
// not depend on which shader asks. Slivers have steep planes: theirs stay within their corners'.
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

// Whether a fragment is behind the opaque depth of its pixel.
bool isHidden(float invW, float opaqueDepthThere) {
#if HAS_OPAQUE
  return push.frame.c.viewProjection[3][2] * invW < opaqueDepthThere;
#else
  return false;
#endif
}

float opaqueDepthAt(ivec2 place) {
#if HAS_OPAQUE
  return texelFetch(opaqueDepth, min(place, ivec2(push.frame.c.size) - 1), 0).r;
#else
  return 0.0;
#endif
}

// Of the material, in the low bits of the word beside its index.
#define PREPARED_ATLAS 3u
#define PREPARED_IGNORE_ALPHA 4u
#define PREPARED_COLORED 8u
#define PREPARED_MATERIAL_SHIFT 4

uint pick(uvec4 v, uint i) { return i == 0u ? v.x : i == 1u ? v.y : i == 2u ? v.z : v.w; }
vec2 pick(vec4 a, vec4 b, uint i) { return i == 0u ? a.xy : i == 1u ? a.zw : i == 2u ? b.xy : b.zw; }

// Triangle `slot` into place `at`.
void prepare(uint at, uint slot, ivec2 corner) {
  const ShadeTriangle s = loadShading(push.shading, slot);
  const GpuMaterial material = push.frame.c.materials.at[s.material];
  const vec2 d = vec2(corner) + 0.5 - s.anchor;
  const vec2 bounds = boundsOfInvW(s);
  vec2 weights = vec2(0.0);
  if (s.minInvW < 0.0) {
    const uint index = s.flags >> TRIANGLE_INDEX_SHIFT;
    weights = vec2(push.irregular.at[index].b1, push.irregular.at[index].b2);
  }
  precise const float b1 = fma(s.b1Slope.x, d.x, fma(s.b1Slope.y, d.y, weights.x));
  precise const float b2 = fma(s.b2Slope.x, d.x, fma(s.b2Slope.y, d.y, weights.y));
  const vec3 n0 = unpackNormal(s.normals[0]);
  const vec3 n1 = unpackNormal(s.normals[1]) - n0, n2 = unpackNormal(s.normals[2]) - n0;
  uvec3 colors = uvec3(0xffffffffu);
  vec2 uv0 = vec2(0.0), uv1 = vec2(0.0), uv2 = vec2(0.0);
  if ((s.flags & (TRIANGLE_COLORED | TRIANGLE_TEXTURED)) != 0u) {
    const uint c = s.flags >> TRIANGLE_CORNER_SHIFT;
    const uint c0 = c & 3u, c1 = (c >> 2) & 3u, c2 = (c >> 4) & 3u;
    const QuadAttributes q = push.attributes.at[slot / 2u];
    colors = uvec3(pick(q.colors, c0), pick(q.colors, c1), pick(q.colors, c2));
    uv0 = pick(q.uvs01, q.uvs23, c0);
    uv1 = pick(q.uvs01, q.uvs23, c1) - uv0;
    uv2 = pick(q.uvs01, q.uvs23, c2) - uv0;
  }
  uint bits = s.material << PREPARED_MATERIAL_SHIFT | material.atlas;
  if (material.ignoreVertexAlpha != 0u) bits |= PREPARED_IGNORE_ALPHA;
  if (colors.y != colors.x || colors.z != colors.x) bits |= PREPARED_COLORED;
  const uint place = at * PREPARED_WORDS;
  prepared[place + 0u] = vec4(originInvW(s, corner), s.invWSlope, bounds.x);
  prepared[place + 1u] = vec4(b1, s.b1Slope, bounds.y);
  prepared[place + 2u] = vec4(b2, s.b2Slope, material.alphaCutoff);
  prepared[place + 3u] = vec4(n0, uintBitsToFloat(s.id));
  prepared[place + 4u] = vec4(n1, uintBitsToFloat(bits));
  prepared[place + 5u] = vec4(n2, uintBitsToFloat(colors.x));
  prepared[place + 6u] = material.baseColor;
  if (material.atlas != 0u || (bits & PREPARED_COLORED) != 0u) {
    prepared[place + 7u] = vec4(uv0, uv1);
    prepared[place + 8u] = vec4(uv2, uintBitsToFloat(colors.y), uintBitsToFloat(colors.z));
  }
}

float preparedInvW(uint at, vec2 pixel) {
  const vec4 plane = prepared[at * PREPARED_WORDS];
  return planeInvW(plane.x, plane.yz, plane.w, prepared[at * PREPARED_WORDS + 1u].w, pixel);
}

uint preparedId(uint at) { return floatBitsToUint(prepared[at * PREPARED_WORDS + 3u].w); }

// The fragment at `pixel` (0..7, 0..3) of the half-block; false where the material cuts it out.
bool shadeFragment(uint at, vec2 pixel, float invW, inout Fragment f) {
  const uint place = at * PREPARED_WORDS;
  const vec4 w = prepared[place], p1 = prepared[place + 1u], p2 = prepared[place + 2u];
  const vec4 n0 = prepared[place + 3u], n1 = prepared[place + 4u], n2 = prepared[place + 5u];
  precise const float over1 = fma(p1.y, pixel.x, fma(p1.z, pixel.y, p1.x));
  precise const float over2 = fma(p2.y, pixel.x, fma(p2.z, pixel.y, p2.x));
  precise const float inverse = 1.0 / invW;
  const float b1 = clamp(over1 * inverse, 0.0, 1.0), b2 = clamp(over2 * inverse, 0.0, 1.0);
  const uint bits = floatBitsToUint(n1.w);
  GpuMaterial material;
  material.baseColor = prepared[place + 6u];
  material.alphaCutoff = p2.w;
  material.atlas = bits & PREPARED_ATLAS;
  material.ignoreVertexAlpha = bits & PREPARED_IGNORE_ALPHA;
  Surface s;
  s.normal = n0.xyz + b1 * n1.xyz + b2 * n2.xyz;
  s.color = unpackUnorm4x8(floatBitsToUint(n2.w));
  if (material.atlas != 0u) {
    material.atlasRect = push.frame.c.materials.at[bits >> PREPARED_MATERIAL_SHIFT].atlasRect;
    const vec4 uvs = prepared[place + 7u];
    const vec2 uv2 = prepared[place + 8u].xy;
    s.uv = uvs.xy + b1 * uvs.zw + b2 * uv2;
    // uv / w is linear on the screen; the quotient rule gives the derivatives of uv.
    s.uvDx = (uvs.xy * w.y + uvs.zw * p1.y + uv2 * p2.y - s.uv * w.y) * inverse;
    s.uvDy = (uvs.xy * w.z + uvs.zw * p1.z + uv2 * p2.z - s.uv * w.z) * inverse;
  }
  if ((bits & PREPARED_COLORED) != 0u) {
    const vec4 c0 = s.color, packed = prepared[place + 8u];
    s.color += b1 * (unpackUnorm4x8(floatBitsToUint(packed.z)) - c0) +
               b2 * (unpackUnorm4x8(floatBitsToUint(packed.w)) - c0);
  }
  f.invW = invW;
  f.id = preparedId(at);
  return shade(material, s, f.color);
}

#endif
