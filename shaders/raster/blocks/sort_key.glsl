// What tri-half-blocks are sorted by.
#ifndef OITLAB_RASTER_SORT_KEY_GLSL
#define OITLAB_RASTER_SORT_KEY_GLSL

#include "raster/blocks/block_types.h"
#include "raster/triangles.glsl"

// 1 / w of a triangle at a place on the screen. Near enough to sort by: the order of fragments is that
// of fragment.glsl.
float roughInvW(Mesh mesh, uint slot, vec2 place) {
#if HAS_UNSNAPPED
  if (isUnsnapped(slot)) {
    const ShadeTriangle t = mesh.unsnapped.at[slot & ~UNSNAPPED].shading;
    return t.invW + dot(t.invWSlope, place - t.anchor);
  }
#endif
  const uvec3 vertices = verticesOf(mesh.quads.at[slot / 2u].corners, slot);
  const vec3 a = mesh.onScreen.at[vertices.x].xyz;
  const vec3 b = mesh.onScreen.at[vertices.y].xyz - a, c = mesh.onScreen.at[vertices.z].xyz - a;
  const vec2 d = place - a.xy;
  const float area = b.x * c.y - b.y * c.x;
  const float rise = b.z * (d.x * c.y - d.y * c.x) + c.z * (b.x * d.y - b.y * d.x);
  return area == 0.0 ? a.z : a.z + rise / area;
}

// 1 / w at the centroid of the covered samples (section 2, phase 2), as bits that sort like it.
uint sortKey(Mesh mesh, uint slot, ivec2 corner, uint mask) {
  const vec2 sums = vec2(bitCount(mask & 0xaaaaaaaau) + 2 * bitCount(mask & 0xccccccccu) +
                             4 * bitCount(mask & 0xf0f0f0f0u),
                         bitCount(mask & 0xff00ff00u) + 2 * bitCount(mask & 0xffff0000u));
  const float invW = roughInvW(mesh, slot, vec2(corner) + 0.5 + sums / float(bitCount(mask)));
  return invW > 0.0 ? floatBitsToUint(invW) : 0u;  // -0.0 would sort in front of all
}

#endif
