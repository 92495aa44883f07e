#version 460
// Puts the lists of one KIND in the order of delivery: 0 short, 1 medium, 2 long. One subgroup per list, or per run of
// SORTED_RUN of a long list, for order_merge.comp to merge.
#define TEAMS ORDER_TEAMS
#include "source/compute_types.h"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { OrderPush push; };

#include "source/order.glsl"

// In registers, or in shared memory.
#define IN_REGISTERS (KIND == 0 && SMALL_SUBGROUP == 0)

#if !IN_REGISTERS
#include "raster/blocks/exact_sort.glsl"

// Sorts the list's elements [begin, begin + count).
void orderRun(uint begin, uint count) {
  const uint lane = gl_SubgroupInvocationID, at = gl_SubgroupID * LIST;
  for (uint i = lane; i < count; i += SUBGROUP_SIZE)
    keys[at + i] = uvec2(orderKey(push.keys.at[block.first + begin + i]), begin + i);
  sortKeys(at, count);
  for (uint i = lane; i < count; i += SUBGROUP_SIZE) {
    const uvec2 key = keys[at + i];
#if KIND == 2
    if (push.run != 0u) {
      push.from.at[block.first + begin + i] = key;
      continue;
    }
#endif
    push.keys.at[block.first + begin + i] = key.y;
  }
  teamBarrier();
}

#else
#include "raster/fragments/team.glsl"

// The primitive id, where keys can be equal.
uint tieOf(uint place) {
#if DELIVER == DELIVER_NEAR_TO_FAR || DELIVER == DELIVER_FAR_TO_NEAR
  return place < block.count ? idOfTriangle(push.mesh, push.list.at[block.first + place].x) : 0u;
#else
  return 0u;
#endif
}

uint keyAt(uint place) { return place < block.count ? orderKey(push.keys.at[block.first + place]) : 0u; }

// A list of at most two elements per lane, in registers: each lane counts the elements in front of its own.
void orderShortList() {
  const uint lane = gl_SubgroupInvocationID, second = SUBGROUP_SIZE + lane;
  const uvec2 own0 = uvec2(keyAt(lane), tieOf(lane));
  uint rank0 = 0u, rank1 = 0u;
  if (block.count <= SUBGROUP_SIZE) {
    for (uint i = 0u; i < block.count; ++i) {
      const uvec2 other = subgroupShuffle(own0, i);
      rank0 += uint(other.x > own0.x || (other.x == own0.x && other.y < own0.y));
    }
  } else {
    const uvec2 own1 = uvec2(keyAt(second), tieOf(second));
    for (uint i = 0u; i < block.count; ++i) {
      const uvec2 other = i < SUBGROUP_SIZE ? subgroupShuffle(own0, i) : subgroupShuffle(own1, i - SUBGROUP_SIZE);
      rank0 += uint(other.x > own0.x || (other.x == own0.x && other.y < own0.y));
      rank1 += uint(other.x > own1.x || (other.x == own1.x && other.y < own1.y));
    }
    if (second < block.count) push.keys.at[block.first + rank1] = second;
  }
  if (lane < block.count) push.keys.at[block.first + rank0] = lane;
}
#endif

TEAM_MAIN void main() {
  if (push.counters.c.lists.overflow != 0u) return;
#if KIND == 2
  const uint lists = subgroupBroadcastFirst(push.counters.c.lists.longLists);
  const uint rows = subgroupBroadcastFirst(push.counters.c.lists.runGroups.y);
  const uint columns = subgroupBroadcastFirst(push.counters.c.lists.runGroups.x);
  for (uint i = gl_WorkGroupID.y; i < lists; i += rows) {
    block = uniformly(push.blocks.at[push.halfBlocks - 1u - i]);
    for (uint begin = SORTED_RUN * gl_WorkGroupID.x; begin < block.count; begin += SORTED_RUN * columns)
      orderRun(begin, min(SORTED_RUN, block.count - begin));
  }
#else
#if KIND == 1
  const uint lists = subgroupBroadcastFirst(push.counters.c.lists.mediumLists);
  const uint groups = subgroupBroadcastFirst(push.counters.c.lists.mediumGroups.x);
#else
  const uint lists = subgroupBroadcastFirst(push.counters.c.lists.shortLists);
  const uint groups = subgroupBroadcastFirst(push.counters.c.lists.shortGroups.x * push.counters.c.lists.shortGroups.y);
#endif
  const uint group = gl_WorkGroupID.y * subgroupBroadcastFirst(push.counters.c.lists.shortGroups.x) + gl_WorkGroupID.x;
  for (uint i = subgroupBroadcastFirst(group * TEAMS + gl_SubgroupID); i < lists; i += groups * TEAMS) {
#if KIND == 1
    block = uniformly(push.medium.at[i].block);
#else
    block = uniformly(push.blocks.at[i]);
#endif
#if IN_REGISTERS
    orderShortList();
#else
    orderRun(0u, block.count);
#endif
  }
#endif
}
