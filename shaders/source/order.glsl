// The order of delivery of a half-block's tri-half-blocks: what they are ordered by. The includer defines DELIVER.
#ifndef OITLAB_SOURCE_ORDER_GLSL
#define OITLAB_SOURCE_ORDER_GLSL

#include "source/compute_types.h"
#include "raster/triangles.glsl"

// A bijection, so that no two ids get the same key (Wellons 2018, the hash "lowbias32").
uint mixed(uint x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

// Whether two keys can be equal. Then the lower primitive id is in front.
#define KEYS_TIE (DELIVER == DELIVER_NEAR_TO_FAR || DELIVER == DELIVER_FAR_TO_NEAR)

// What to order by: the larger one comes first. `key`: as blocks.comp has stored it.
uint orderKey(OrderRule rule, uint key) {
#if DELIVER == DELIVER_SUBMISSION
  return ~(uint64_t(rule.sequence) != 0ul ? rule.sequence.at[key] : key);
#elif DELIVER == DELIVER_SHUFFLED
  return mixed(key ^ mixed(rule.seed));
#elif DELIVER == DELIVER_FAR_TO_NEAR
  return ~key;
#else
  return key;
#endif
}

#endif
