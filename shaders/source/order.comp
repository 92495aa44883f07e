#version 460
// Puts the lists of one KIND in the order of delivery, but those that are ordered in passing: 0 short, 1 medium, 2 long.
// One subgroup per list, or per run of SORTED_RUN of a long list, for order_merge.comp to merge.
#define TEAMS ORDER_TEAMS
#include "source/compute_types.h"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { OrderPush push; };

#include "source/order_pass.glsl"

// Lists of one kind are sorted in registers, others in shared memory, of which few subgroups have enough.
#if KIND == 1 && DELIVER == DELIVER_SUBMISSION && SMALL_SUBGROUP == 0
#define ORDER_KEYS 4
#include "source/order_registers.glsl"
#define ORDER_KEYS 8
#include "source/order_registers.glsl"
#define ORDER_KEYS 16
#include "source/order_registers.glsl"

void orderRun(uint begin, uint count) {
  if (count <= 4u * SUBGROUP_SIZE) orderList4(block);
  else if (count <= 8u * SUBGROUP_SIZE) orderList8(block);
  else orderList16(block);
}
#else
#include "raster/blocks/exact_sort.glsl"

// Sorts the list's elements [begin, begin + count).
void orderRun(uint begin, uint count) {
  const uint lane = gl_SubgroupInvocationID, at = gl_SubgroupID * LIST;
  for (uint i = lane; i < count; i += SUBGROUP_SIZE)
    keys[at + i] = uvec2(orderKey(push.rule, push.keys.at[block.first + begin + i]), begin + i);
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
    if (block.count > ORDERED_IN_PASSING(SUBGROUP_SIZE)) orderRun(0u, block.count);
  }
#endif
}
