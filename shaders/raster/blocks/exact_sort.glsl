// Sorting by depth and primitive id within a subgroup, in shared memory. The includer defines SUBGROUP_SIZE, TEAMS
// and LIST, and idOfKey(), which breaks ties.
#ifndef OITLAB_RASTER_EXACT_SORT_GLSL
#define OITLAB_RASTER_EXACT_SORT_GLSL

#include "raster/fragments/team.glsl"

const uint noKey = 0xffffffffu;  // in y: padding, behind everything

// x: depth, larger is nearer; y: index.
shared uvec2 keys[TEAMS * LIST];

uint idOfKey(uvec2 key);

bool isInFront(uvec2 a, uvec2 b) {
  if (a.x != b.x) return a.x > b.x;
  if (a.y == noKey || b.y == noKey) return b.y == noKey && a.y != noKey;
  return idOfKey(a) < idOfKey(b);
}

// Sorts keys[first, first + count), front to back; count <= LIST. All lanes of the subgroup must call this.
void sortKeys(uint first, uint count) {
  const uint lane = gl_SubgroupInvocationID;
  teamBarrier();
  if (count <= SUBGROUP_SIZE) {
    // Few keys: each lane counts the keys before its own.
    const uvec2 own = lane < count ? keys[first + lane] : uvec2(0u, noKey);
    uint rank = 0u;
    for (uint i = 0u; i < count; ++i) rank += uint(isInFront(keys[first + i], own));
    teamBarrier();
    if (lane < count) keys[first + rank] = own;
    teamBarrier();
    return;
  }
  // Bitonic (Batcher 1968), padded to a power of two.
  uint padded = 2u * SUBGROUP_SIZE;
  while (padded < count) padded *= 2u;
  for (uint i = count + lane; i < padded; i += SUBGROUP_SIZE) keys[first + i] = uvec2(0u, noKey);
  for (uint size = 2u; size <= padded; size *= 2u) {
    for (uint step = size / 2u; step > 0u; step /= 2u) {
      teamBarrier();
      for (uint i = lane; i < padded / 2u; i += SUBGROUP_SIZE) {
        const uint low = 2u * i - (i & (step - 1u)), high = low + step;
        const uvec2 a = keys[first + low], b = keys[first + high];
        const bool upwards = (low & size) == 0u;
        if (upwards ? isInFront(b, a) : isInFront(a, b)) {
          keys[first + low] = b;
          keys[first + high] = a;
        }
      }
    }
  }
  teamBarrier();
}

#endif
