#version 460
// Stage 3, phase 2: sorts the lists that are too long for ordered raster, one subgroup per half-block, and replaces
// the depths by the order. This is a separate program because keys take registers or shared memory that raster
// needs for other purposes (docs/performance.md). Keys are sorted in registers where a lane has at most 16 of them;
// with SMALL_SUBGROUP it has more. HIGH would need 32, for which NVIDIA's compiler (580.159.04) made code that
// sorts wrongly (lucid_sort_test.cpp).
//
// HIGH 1: lists with more than MEDIUM_LIST. Those with more than HIGH_LIST need no order (blend.comp).
#include "lucid/lucid_types.h"
#include "raster/blocks/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { BlendPush push; };

#if SMALL_SUBGROUP || HIGH
#include "lucid/sort.glsl"

void sortHalfBlock(HalfBlock block) {
  const uint first = gl_SubgroupID * LIST;
  const uint placeMask = sortList(first, block);
  for (uint i = gl_SubgroupInvocationID; i < block.count; i += SUBGROUP_SIZE)
    push.keys.at[block.first + i] = keys[first + i] & placeMask;
  teamBarrier();
}
#else
#define SORT_KEYS 4
#include "lucid/register_sort.glsl"
#define SORT_KEYS 8
#include "lucid/register_sort.glsl"
#define SORT_KEYS 16
#include "lucid/register_sort.glsl"

void sortHalfBlock(HalfBlock block) {
  if (block.count <= 4u * SUBGROUP_SIZE) sortAndStore4(block);
  else if (block.count <= 8u * SUBGROUP_SIZE) sortAndStore8(block);
  else sortAndStore16(block);
}
#endif

TEAM_MAIN void main() {
  if (push.counters.c.lists.overflow != 0u) return;
#if HIGH
  const uint groups = push.counters.c.lists.longGroups.x, count = subgroupBroadcastFirst(push.counters.c.lists.longLists);
#else
  // Not mediumGroups.x, to which ordered raster adds at the same time.
  const uint count = subgroupBroadcastFirst(push.counters.c.lists.mediumLists);
  const uint groups = min((count + TEAMS - 1u) / TEAMS, MAX_GROUPS);
#endif
  const uint stride = subgroupBroadcastFirst(groups) * TEAMS;
  for (uint job = subgroupBroadcastFirst(gl_WorkGroupID.x * TEAMS + gl_SubgroupID); job < count; job += stride) {
#if HIGH
    const HalfBlock block = uniformly(push.blocks.at[push.halfBlocks - 1u - job]);
    if (block.count <= LIST) sortHalfBlock(block);
#else
    sortHalfBlock(uniformly(push.medium.at[job].block));
#endif
  }
}
