// Sorting within a subgroup, in shared memory. The includer defines SUBGROUP_SIZE, TEAMS and LIST, and declares
// `push` with keys.
#ifndef OITLAB_LUCID_SORT_GLSL
#define OITLAB_LUCID_SORT_GLSL

#include "lucid/pack_key.glsl"
#include "raster/fragments/team.glsl"

shared uint keys[TEAMS * LIST];

#define RANKED 2u  // up to so many keys per lane, counting is faster

// Sorts keys[first, first + count), ascending; count <= LIST. All lanes of the subgroup must call this.
void sortKeys(uint first, uint count) {
  const uint lane = gl_SubgroupInvocationID;
  teamBarrier();
  if (count <= RANKED * SUBGROUP_SIZE) {
    // Few keys: each lane counts the keys before its own. The reads are independent, while each step of a bitonic
    // sort waits for the one before.
    uint own[RANKED], rank[RANKED];
    [[unroll]] for (uint t = 0u; t < RANKED; ++t) {
      own[t] = t * SUBGROUP_SIZE + lane < count ? keys[first + t * SUBGROUP_SIZE + lane] : padding;
      rank[t] = 0u;
    }
    for (uint i = 0u; i < count; ++i) {
      const uint other = keys[first + i];
      [[unroll]] for (uint t = 0u; t < RANKED; ++t) rank[t] += uint(other < own[t]);
    }
    teamBarrier();
    [[unroll]] for (uint t = 0u; t < RANKED; ++t)
      if (own[t] != padding) keys[first + rank[t]] = own[t];
    teamBarrier();
    return;
  }
  // Bitonic (Batcher 1968), padded to a power of two.
  uint padded = 2u * RANKED * SUBGROUP_SIZE;
  while (padded < count) padded *= 2u;
  for (uint i = count + lane; i < padded; i += SUBGROUP_SIZE) keys[first + i] = padding;
  for (uint size = 2u; size <= padded; size *= 2u) {
    for (uint step = size / 2u; step > 0u; step /= 2u) {
      teamBarrier();
      for (uint i = lane; i < padded / 2u; i += SUBGROUP_SIZE) {
        const uint low = first + 2u * i - (i & (step - 1u)), high = low + step;
        const uint a = keys[low], b = keys[high];
        const bool upwards = ((2u * i - (i & (step - 1u))) & size) == 0u;
        keys[low] = upwards ? min(a, b) : max(a, b);
        keys[high] = upwards ? max(a, b) : min(a, b);
      }
    }
  }
  teamBarrier();
}

// Sorts the list of a half-block by depth. Afterwards keys[first, first + block.count) hold its places, front to
// back, in the bits of the returned mask. All lanes of the subgroup must call this.
uint sortList(uint first, HalfBlock block) {
  const uint lane = gl_SubgroupInvocationID;
  // Depths are scaled to their range, so that few bits tell them apart.
  uint low = 0xffffffffu, high = 0u;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE) {
    const uint key = push.keys.at[block.first + i];
    keys[first + i] = key;
    low = min(low, key);
    high = max(high, key);
  }
  const float farthest = uintBitsToFloat(subgroupMin(low)), nearest = uintBitsToFloat(subgroupMax(high));
  const uint bits = findMSB(block.count) + 1;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE)
    keys[first + i] = packKey(uintBitsToFloat(keys[first + i]), farthest, nearest, i, bits);
  sortKeys(first, block.count);
  return (1u << bits) - 1u;
}

#endif
