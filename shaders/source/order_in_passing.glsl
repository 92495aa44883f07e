// Puts a short list in the order of delivery while it is delivered: each lane counts the items in front of its own two.
// The includer defines source(), and includes prepared.glsl.
#ifndef OITLAB_SOURCE_ORDER_IN_PASSING_GLSL
#define OITLAB_SOURCE_ORDER_IN_PASSING_GLSL

#include "source/order.glsl"

// Items `lane` and SUBGROUP_SIZE + `lane` of a list, and their places in the order of delivery.
struct OwnItems {
  TriHalfBlock items[2];
  uint places[2];
};

// The larger one is delivered first.
bool isBefore(uvec2 a, uvec2 b) {
#if KEYS_TIE
  return a.x > b.x || (a.x == b.x && a.y < b.y);
#else
  return a.x > b.x;
#endif
}

// block.count <= ORDERED_IN_PASSING(SUBGROUP_SIZE). All lanes of the subgroup must call this.
OwnItems orderInPassing(HalfBlock block) {
  OwnItems own;
  uvec2 keys[2];
  [[unroll]] for (uint k = 0u; k < 2u; ++k) {
    const uint i = k * SUBGROUP_SIZE + gl_SubgroupInvocationID;
    own.items[k] = TriHalfBlock(0u, 0u);
    own.places[k] = 0u;
    keys[k] = uvec2(0u, ~0u);  // before no other
    if (i >= block.count) continue;
    own.items[k] = itemAt(source().c.list, block.first + i);
    keys[k].x = orderKey(source().c.rule, source().c.order.at[block.first + i]);
#if KEYS_TIE
    keys[k].y = idOfTriangle(source().c.mesh, own.items[k].triangle);
#endif
  }
  // In steps of four, which divide SUBGROUP_SIZE.
  if (block.count <= SUBGROUP_SIZE) {
    for (uint i = 0u; i < block.count; i += 4u)
      [[unroll]] for (uint k = 0u; k < 4u; ++k) own.places[0] += uint(isBefore(subgroupShuffle(keys[0], i + k), keys[0]));
    return own;
  }
  for (uint i = 0u; i < SUBGROUP_SIZE; ++i) {
    const uvec2 other0 = subgroupShuffle(keys[0], i), other1 = subgroupShuffle(keys[1], i);
    own.places[0] += uint(isBefore(other0, keys[0])) + uint(isBefore(other1, keys[0]));
    own.places[1] += uint(isBefore(other0, keys[1])) + uint(isBefore(other1, keys[1]));
  }
  return own;
}

// Item `first` + lane in the order of delivery, by way of shared memory. Past the end: an empty one. All lanes must call this.
TriHalfBlock itemInOrder(OwnItems own, uint first, uint count) {
  const uint lane = gl_SubgroupInvocationID, at = gl_SubgroupID * PREPARED_COUNT * PREPARED_WORDS;
  [[unroll]] for (uint k = 0u; k < 2u; ++k) {
    const uint place = own.places[k] - first;  // wraps around for an earlier batch
    if (own.items[k].mask != 0u && place < SUBGROUP_SIZE)
      preparedWords[at + place].xy = uintBitsToFloat(uvec2(own.items[k].triangle, own.items[k].mask));
  }
  teamBarrier();
  TriHalfBlock item = TriHalfBlock(0u, 0u);
  if (first + lane < count) {
    const uvec2 words = floatBitsToUint(preparedWords[at + lane].xy);
    item = TriHalfBlock(words.x, words.y);
  }
  teamBarrier();
  return item;
}

#endif
