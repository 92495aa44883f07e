// The order of a list in registers, ORDER_KEYS keys per lane (4, 8 or 16, as a plain number): a bitonic sort of keys and
// places that waits for no memory. Included once for each number. No two keys may be equal, and none 0.
#define EXCHANGE(k, i, j, isFirst) \
  { \
    const uvec2 a = k[i], b = k[j]; \
    const bool keep = (a.x > b.x) == (isFirst); \
    k[i] = keep ? a : b; \
    k[j] = keep ? b : a; \
  }
#include "raster/blocks/networks.glsl"
#include "raster/fragments/team.glsl"

#define EACH_KEY(F) NETWORK(EACH_, ORDER_KEYS)(F)

// Puts the list in order, the largest key first. It has at most ORDER_KEYS * SUBGROUP_SIZE entries. All lanes of the
// subgroup must call this.
void NETWORK(orderList, ORDER_KEYS)(HalfBlock block) {
  const uint lane = gl_SubgroupInvocationID;
  uvec2 keys[ORDER_KEYS];  // key e of the order is keys[e % ORDER_KEYS] of lane e / ORDER_KEYS
#define LOAD(i) \
  { \
    const uint place = i * SUBGROUP_SIZE + lane; \
    keys[i] = uvec2(place < block.count ? orderKey(push.rule, push.keys.at[block.first + place]) : 0u, place); \
  }
  EACH_KEY(LOAD)
#undef LOAD
  teamBarrier();  // before the order replaces the keys in memory
  const bool even = (lane & 1u) == 0u;
  NETWORK(SORT_, ORDER_KEYS)(keys, 0, even)
  // Runs of more and more lanes, merged in pairs.
  [[dont_unroll]] for (uint lanes = 2u; lanes <= SUBGROUP_SIZE; lanes *= 2u) {
    const bool isFirst = (lane & lanes) == 0u || lanes == SUBGROUP_SIZE;
    [[dont_unroll]] for (uint step = lanes / 2u; step > 0u; step /= 2u) {
      const bool takesLarger = ((lane & step) == 0u) == isFirst;
#define SHUFFLE(i) \
  { \
    const uvec2 other = subgroupShuffleXor(keys[i], step); \
    if ((other.x > keys[i].x) == takesLarger) keys[i] = other; \
  }
      EACH_KEY(SHUFFLE)
#undef SHUFFLE
    }
    NETWORK(MERGE_, ORDER_KEYS)(keys, 0, isFirst)
  }
#define PUT(i) \
  if (lane * ORDER_KEYS + i < block.count) push.keys.at[block.first + lane * ORDER_KEYS + i] = keys[i].y;
  EACH_KEY(PUT)
#undef PUT
}

#undef EXCHANGE
#undef EACH_KEY
#undef ORDER_KEYS
