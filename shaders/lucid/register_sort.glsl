// A half-block's list sorted in registers, SORT_KEYS keys a lane. Included once for each number, with
// the names SORT and STORE, and WITHIN, MERGE and EACH of networks.glsl for that number; the includer
// declares a `push` that has keys.
#include "lucid/networks.glsl"
#include "lucid/pack_key.glsl"
#include "raster/fragments/team.glsl"

#extension GL_KHR_shader_subgroup_shuffle : require

// Returns the mask of those bits of `keys` that hold the place in the list. Key e, counted front to back, is
// keys[e % SORT_KEYS] of lane e / SORT_KEYS, so that most steps stay within a lane, and none waits for memory. The
// list has at most SORT_KEYS * SUBGROUP_SIZE entries. All lanes of the subgroup must call this.
uint SORT(HalfBlock block, out uint keys[SORT_KEYS]) {
  const uint lane = gl_SubgroupInvocationID, bits = findMSB(block.count) + 1;
  uint low = 0xffffffffu, high = 0u;
#define LOAD(i) \
  keys[i] = padding; \
  if (i * SUBGROUP_SIZE + lane < block.count) { \
    keys[i] = push.keys.at[block.first + i * SUBGROUP_SIZE + lane]; \
    low = min(low, keys[i]); \
    high = max(high, keys[i]); \
  }
  EACH(LOAD)
#undef LOAD
  teamBarrier();  // before the order replaces the depths in memory
  const float farthest = uintBitsToFloat(subgroupMin(low)), nearest = uintBitsToFloat(subgroupMax(high));
#define PACK(i) \
  if (i * SUBGROUP_SIZE + lane < block.count) \
    keys[i] = packKey(uintBitsToFloat(keys[i]), farthest, nearest, i * SUBGROUP_SIZE + lane, bits);
  EACH(PACK)
#undef PACK
  const bool even = (lane & 1u) == 0u;
  WITHIN(keys, 0, even)
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
      EACH(SHUFFLE)
#undef SHUFFLE
    }
    MERGE(keys, 0, upwards)
  }
  return (1u << bits) - 1u;
}

// Sorts the list, and replaces the depths by the order.
void STORE(HalfBlock block) {
  uint keys[SORT_KEYS];
  const uint placeMask = SORT(block, keys), first = gl_SubgroupInvocationID * SORT_KEYS;
#define PUT(i) \
  if (first + i < block.count) push.keys.at[block.first + first + i] = keys[i] & placeMask;
  EACH(PUT)
#undef PUT
}

#undef SORT_KEYS
#undef SORT
#undef STORE
#undef WITHIN
#undef MERGE
#undef EACH
