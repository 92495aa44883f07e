// Sample shading (section 2, phase 3): a triangle made ready for one half-block, and its fragment at
// one pixel. The including shader defines SUBGROUP_SIZE and TEAMS and declares `push`.
#ifndef OITLAB_LUCID_FRAGMENT_GLSL
#define OITLAB_LUCID_FRAGMENT_GLSL

#include "common/shade.glsl"
#include "lucid/lucid_types.h"

// What a triangle's fragments need, with the half-block's first sample as the origin: made once for
// all of them, by one lane, and read by all lanes. 36 words, so that the four-word accesses of
// neighbouring lanes fall into different banks of shared memory.
#define PREPARED_WORDS 9u
shared vec4 prepared[TEAMS * SUBGROUP_SIZE * PREPARED_WORDS];

struct Fragment {
  float depth;
  uint id;
  vec4 color;  // straight, linear
};

// 1 / w at the half-block's first sample, and at a pixel of it. `precise`: the order of fragments must
// not depend on which shader asks. Slivers have steep planes: theirs stay within their corners'.
float originInvW(ShadeTriangle s, ivec2 corner) {
  const vec2 d = vec2(corner) + 0.5 - s.anchor;
  precise const float invW = s.invW.x + (s.invW.y * d.x + s.invW.z * d.y);
  return invW;
}

float planeInvW(float origin, vec2 gradient, float low, float high, vec2 pixel) {
  precise const float invW = origin + (gradient.x * pixel.x + gradient.y * pixel.y);
  return clamp(invW, low, high);
}

vec2 boundsOfInvW(ShadeTriangle s) {
  return s.minInvW >= 0.0 ? vec2(s.minInvW, s.invW.x) : vec2(0.0, uintBitsToFloat(0x7f7fffffu));
}

float boundedInvW(float origin, ShadeTriangle s, vec2 pixel) {
  const vec2 bounds = boundsOfInvW(s);
  return planeInvW(origin, s.invW.yz, bounds.x, bounds.y, pixel);
}

// Into place `at`.
void prepare(uint at, TriHalfBlock item, ivec2 corner) {
  const RasterTriangle t = push.triangles.at[item.triangle];
  const ShadeTriangle s = push.shading.at[item.triangle];
  const uint flags = t.flags >> TRIANGLE_CORNER_SHIFT;
  const uint c0 = flags & 3u, c1 = (flags >> 2) & 3u, c2 = (flags >> 4) & 3u;
  const vec2 d = vec2(corner) + 0.5 - s.anchor;
  const vec2 bounds = boundsOfInvW(s);
  precise const float b1 = s.b1.x + (s.b1.y * d.x + s.b1.z * d.y);
  precise const float b2 = s.b2.x + (s.b2.y * d.x + s.b2.z * d.y);
  const uint quad = item.triangle / 2u;
  const vec3 n0 = unpackNormal(push.attributes.at[quad].normals[c0]);
  const vec3 n1 = unpackNormal(push.attributes.at[quad].normals[c1]) - n0;
  const vec3 n2 = unpackNormal(push.attributes.at[quad].normals[c2]) - n0;
  const vec2 uv0 = push.attributes.at[quad].uvs[c0];
  const vec2 uv1 = push.attributes.at[quad].uvs[c1] - uv0;
  const vec2 uv2 = push.attributes.at[quad].uvs[c2] - uv0;
  const uint place = at * PREPARED_WORDS;
  prepared[place + 0u] = vec4(originInvW(s, corner), s.invW.yz, bounds.x);
  prepared[place + 1u] = vec4(b1, s.b1.yz, bounds.y);
  prepared[place + 2u] = vec4(b2, s.b2.yz, uintBitsToFloat(item.mask));
  prepared[place + 3u] = vec4(n0, uintBitsToFloat(t.id));
  prepared[place + 4u] = vec4(n1, uintBitsToFloat(push.attributes.at[quad].material));
  prepared[place + 5u] = vec4(n2, uintBitsToFloat(push.attributes.at[quad].colors[c0]));
  prepared[place + 6u] = vec4(uv0, uv1);
  prepared[place + 7u] = vec4(uv2, uintBitsToFloat(push.attributes.at[quad].colors[c1]),
                              uintBitsToFloat(push.attributes.at[quad].colors[c2]));
}

uint preparedMask(uint at) { return floatBitsToUint(prepared[at * PREPARED_WORDS + 2u].w); }

float preparedInvW(uint at, vec2 pixel) {
  const vec4 plane = prepared[at * PREPARED_WORDS];
  return planeInvW(plane.x, plane.yz, plane.w, prepared[at * PREPARED_WORDS + 1u].w, pixel);
}

float depthOf(float invW) { return push.frame.c.viewProjection[3][2] * invW; }

// The fragment at `pixel` (0..7, 0..3) of the half-block; false where the material cuts it out.
bool shadeFragment(uint at, vec2 pixel, float invW, out Fragment f) {
  const uint place = at * PREPARED_WORDS;
  const vec4 w = prepared[place], p1 = prepared[place + 1u], p2 = prepared[place + 2u];
  const vec4 n0 = prepared[place + 3u], n1 = prepared[place + 4u], n2 = prepared[place + 5u];
  precise const float over1 = p1.x + (p1.y * pixel.x + p1.z * pixel.y);
  precise const float over2 = p2.x + (p2.y * pixel.x + p2.z * pixel.y);
  precise const float inverse = 1.0 / invW;
  const float b1 = clamp(over1 * inverse, 0.0, 1.0), b2 = clamp(over2 * inverse, 0.0, 1.0);
  const GpuMaterial material = push.frame.c.materials.at[floatBitsToUint(n1.w)];
  Surface s;
  s.normal = n0.xyz + b1 * n1.xyz + b2 * n2.xyz;
  if (material.atlas != 0u) {
    const vec4 uvs = prepared[place + 6u];
    const vec2 uv2 = prepared[place + 7u].xy;
    s.uv = uvs.xy + b1 * uvs.zw + b2 * uv2;
    // uv / w is linear on the screen; the quotient rule gives the derivatives of uv.
    s.uvDx = (uvs.xy * w.y + uvs.zw * p1.y + uv2 * p2.y - s.uv * w.y) * inverse;
    s.uvDy = (uvs.xy * w.z + uvs.zw * p1.z + uv2 * p2.z - s.uv * w.z) * inverse;
  }
  const uint color0 = floatBitsToUint(n2.w);
  const uint color1 = floatBitsToUint(prepared[place + 7u].z);
  const uint color2 = floatBitsToUint(prepared[place + 7u].w);
  s.color = unpackUnorm4x8(color0);
  if (color1 != color0 || color2 != color0)
    s.color += b1 * (unpackUnorm4x8(color1) - s.color) + b2 * (unpackUnorm4x8(color2) - s.color);
  f.depth = depthOf(invW);
  f.id = floatBitsToUint(n0.w);
  return shade(material, s, f.color);
}

#endif
