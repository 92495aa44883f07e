// What tri-half-blocks are sorted by.
#ifndef OITLAB_LUCID_SORT_KEY_GLSL
#define OITLAB_LUCID_SORT_KEY_GLSL

#include "lucid/lucid_types.h"

// 1 / w at the centroid of the covered samples (section 2, phase 2), as bits that sort like it.
uint sortKey(ShadeTriangle t, ivec2 corner, uint mask) {
  const vec2 sums = vec2(bitCount(mask & 0xaaaaaaaau) + 2 * bitCount(mask & 0xccccccccu) +
                             4 * bitCount(mask & 0xf0f0f0f0u),
                         bitCount(mask & 0xff00ff00u) + 2 * bitCount(mask & 0xffff0000u));
  const vec2 d = vec2(corner) + 0.5 + sums / float(bitCount(mask)) - t.anchor;
  const float invW = t.invW + t.invWSlope.x * d.x + t.invWSlope.y * d.y;
  return invW > 0.0 ? floatBitsToUint(invW) : 0u;  // -0.0 would sort in front of all
}

#endif
