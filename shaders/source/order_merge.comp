#version 460
// Merges the sorted runs of long lists in pairs, one invocation per element. Its place is that in its own run, and the
// number of elements of the other run that are in front of it.
#include "source/compute_types.h"

layout(local_size_x = MERGE_GROUP) in;
layout(push_constant, scalar) uniform Push { OrderPush push; };

#include "source/order_pass.glsl"

bool isInFront(uvec2 a, uvec2 b) { return a.x != b.x ? a.x > b.x : idOfKey(a) < idOfKey(b); }

void mergeElement(uint i) {
  const uvec2 own = push.from.at[block.first + i];
  const uint number = i / push.run, pair = number & ~1u;
  const uint otherBegin = min((number ^ 1u) * push.run, block.count);
  const uint otherEnd = min(otherBegin + push.run, block.count);
  uint low = otherBegin, high = otherEnd;  // the first element that is not in front lies in [low, high]
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (isInFront(push.from.at[block.first + middle], own)) low = middle + 1u;
    else high = middle;
  }
  const uint place = pair * push.run + (i - number * push.run) + (low - otherBegin);
  if (push.last != 0u) push.keys.at[block.first + place] = own.y;
  else push.to.at[block.first + place] = own;
}

void main() {
  if (push.counters.c.lists.overflow != 0u) return;
  const uint lists = push.counters.c.lists.longLists;
  for (uint i = gl_WorkGroupID.y; i < lists; i += push.counters.c.lists.mergeGroups.y) {
    block = push.blocks.at[push.halfBlocks - 1u - i];
    const uint step = MERGE_GROUP * push.counters.c.lists.mergeGroups.x;
    for (uint element = MERGE_GROUP * gl_WorkGroupID.x + gl_LocalInvocationIndex; element < block.count; element += step)
      mergeElement(element);
  }
}
