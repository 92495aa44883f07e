// The order of delivery of a half-block's tri-half-blocks. Keys are pairs: what to order by (the larger one first), and
// the place in the list. The includer declares `push` as OrderPush, sets `block`, and defines DELIVER.
#ifndef OITLAB_SOURCE_ORDER_GLSL
#define OITLAB_SOURCE_ORDER_GLSL

#include "source/compute_types.h"
#include "raster/triangles.glsl"

HalfBlock block;

// Two tri-half-blocks of equal depth.
uint idOfKey(uvec2 key) { return idOfTriangle(push.mesh, push.list.at[block.first + key.y].x); }

// A bijection, so that no two ids get the same key (Wellons 2018, the hash "lowbias32").
uint mixed(uint x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

// `key`: as blocks.comp has stored it.
uint orderKey(uint key) {
#if DELIVER == DELIVER_SUBMISSION
  return ~(uint64_t(push.sequence) != 0ul ? push.sequence.at[key] : key);
#elif DELIVER == DELIVER_SHUFFLED
  return mixed(key ^ mixed(push.seed));
#elif DELIVER == DELIVER_FAR_TO_NEAR
  return ~key;
#else
  return key;
#endif
}

#endif
