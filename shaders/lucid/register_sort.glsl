// A half-block's list sorted in registers, SORT_KEYS keys per lane. The includer defines SORT_KEYS before each include
// (1, 2, 4, 8 or 16, as a plain number), and declares a `push` that has keys.
#include "raster/blocks/networks.glsl"
#include "lucid/pack_key.glsl"
#include "raster/fragments/team.glsl"

#extension GL_KHR_shader_subgroup_shuffle : require

#define EACH_KEY(F) NETWORK(EACH_, SORT_KEYS)(F)
#define SORT_LANE(keys, up) NETWORK(SORT_, SORT_KEYS)(keys, 0, up)
#define MERGE_LANE(keys, up) NETWORK(MERGE_, SORT_KEYS)(keys, 0, up)

// Returns the mask of those bits of `keys` that hold the place in the list. Key e, counted front to back, is
// keys[e % SORT_KEYS] of lane e / SORT_KEYS, so that most steps stay within a lane, and none waits for memory. The
// list has at most SORT_KEYS * SUBGROUP_SIZE entries. All lanes of the subgroup must call this.
uint sortInRegisters(HalfBlock block, out uint keys[SORT_KEYS]) {
  const uint lane = gl_SubgroupInvocationID, bits = findMSB(block.count) + 1;
  uint low = 0xffffffffu, high = 0u;
#define LOAD(i) \
  keys[i] = padding; \
  if (i * SUBGROUP_SIZE + lane < block.count) { \
    keys[i] = push.keys.at[block.first + i * SUBGROUP_SIZE + lane]; \
    low = min(low, keys[i]); \
    high = max(high, keys[i]); \
  }
  EACH_KEY(LOAD)
#undef LOAD
  teamBarrier();  // before the order replaces the depths in memory
  const float farthest = uintBitsToFloat(subgroupMin(low)), nearest = uintBitsToFloat(subgroupMax(high));
#define PACK(i) \
  if (i * SUBGROUP_SIZE + lane < block.count) \
    keys[i] = packKey(uintBitsToFloat(keys[i]), farthest, nearest, i * SUBGROUP_SIZE + lane, bits);
  EACH_KEY(PACK)
#undef PACK
  const bool even = (lane & 1u) == 0u;
  SORT_LANE(keys, even)
  // Runs of more and more lanes, merged in pairs.
  [[dont_unroll]] for (uint lanes = 2u; lanes <= SUBGROUP_SIZE; lanes *= 2u) {
    const bool upwards = (lane & lanes) == 0u || lanes == SUBGROUP_SIZE;
    [[dont_unroll]] for (uint step = lanes / 2u; step > 0u; step /= 2u) {
      const bool takesLow = ((lane & step) == 0u) == upwards;
#define SHUFFLE(i) \
  { \
    const uint other = subgroupShuffleXor(keys[i], step); \
    keys[i] = takesLow ? min(keys[i], other) : max(keys[i], other); \
  }
      EACH_KEY(SHUFFLE)
#undef SHUFFLE
    }
    MERGE_LANE(keys, upwards)
  }
  return (1u << bits) - 1u;
}

// sortAndStore4() and so on: sorts the list, and replaces the depths by the order.
void NETWORK(sortAndStore, SORT_KEYS)(HalfBlock block) {
  uint keys[SORT_KEYS];
  const uint placeMask = sortInRegisters(block, keys), first = gl_SubgroupInvocationID * SORT_KEYS;
#define PUT(i) \
  if (first + i < block.count) push.keys.at[block.first + first + i] = keys[i] & placeMask;
  EACH_KEY(PUT)
#undef PUT
}

#undef EACH_KEY
#undef SORT_LANE
#undef MERGE_LANE
#undef SORT_KEYS
