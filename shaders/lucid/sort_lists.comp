#version 460
// Stage 3, phase 2: sorts the lists that ordered raster does not, a subgroup a half-block, and leaves
// their order in place of the depths. In a program of its own: keys take shared memory, which raster needs
// for other things (docs/performance.md).
//
// HIGH 1: lists of more than LOW_LIST, of which those that are too long here need no order (blend.comp).
#include "lucid/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { BlendPush push; };

#include "lucid/sort.glsl"

void sortHalfBlock(HalfBlock block) {
  const uint first = gl_SubgroupID * LIST;
  const uint placeMask = sortList(first, block);
  storeOrder(first, block, placeMask);
  teamBarrier();
}

TEAM_MAIN void main() {
  if (push.counters.c.overflow != 0u) return;
#if HIGH
  const uint groups = push.counters.c.high.x, count = subgroupBroadcastFirst(push.counters.c.highLists);
#else
  // Not low.x, which ordered raster adds to at the same time.
  const uint count = subgroupBroadcastFirst(push.counters.c.lowLists);
  const uint groups = min((count + TEAMS - 1u) / TEAMS, MAX_GROUPS);
#endif
  const uint stride = subgroupBroadcastFirst(groups) * TEAMS;
  for (uint job = subgroupBroadcastFirst(gl_WorkGroupID.x * TEAMS + gl_SubgroupID); job < count; job += stride) {
#if HIGH
    const HalfBlock block = uniformly(push.blocks.at[push.halfBlocks - 1u - job]);
    if (block.count <= LIST) sortHalfBlock(block);
#else
    sortHalfBlock(uniformly(push.filterJobs.at[job].block));
#endif
  }
}
