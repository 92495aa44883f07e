#version 460
// One workgroup a digit: turns the counts of its blocks into the number in the blocks before.
#include "common/sort/group_scan.glsl"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { SortPush push; };

void main() {
  const uint digit = gl_WorkGroupID.x;
  const uint row = digit * push.blocks;
  uint before = 0u;
  for (uint first = 0u; first < push.blocks; first += SORT_BLOCK) {
    const uint start = first + gl_LocalInvocationIndex * SORT_ITEMS;
    const uint end = min(start + SORT_ITEMS, push.blocks);
    uint sum = 0u;
    for (uint block = start; block < end; ++block) sum += push.counts.at[row + block];
    uint total;
    uint running = before + exclusiveSum(sum, total);
    for (uint block = start; block < end; ++block) {
      const uint count = push.counts.at[row + block];
      push.counts.at[row + block] = running;
      running += count;
    }
    before += total;
  }
  if (gl_LocalInvocationIndex == 0u) push.totals.at[digit] = before;
}
