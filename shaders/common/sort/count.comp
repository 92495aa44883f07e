#version 460
// How many elements of a block have each digit.
#include "common/sort/sort_types.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { SortPush push; };

shared uint digits[SORT_DIGITS];

void main() {
  const uint thread = gl_LocalInvocationIndex;
  const uint block = gl_WorkGroupID.x;
  if (thread < SORT_DIGITS) digits[thread] = 0u;
  barrier();
  for (uint i = 0u; i < SORT_ITEMS; ++i) {
    const uint element = block * SORT_BLOCK + i * SORT_GROUP + thread;
    if (element < push.count)
      atomicAdd(digits[push.keysIn.at[element] >> push.shift & (SORT_DIGITS - 1u)], 1u);
  }
  barrier();
  if (thread < SORT_DIGITS) push.counts.at[thread * push.blocks + block] = digits[thread];
}
