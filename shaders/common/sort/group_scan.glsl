// Sums over a workgroup of SORT_GROUP invocations, by barriers alone: whatever the subgroup size.
#ifndef OITLAB_GROUP_SCAN_GLSL
#define OITLAB_GROUP_SCAN_GLSL

#include "common/sort/sort_types.h"

shared uint scanned[SORT_GROUP];

// The sum of `value` over the invocations before this one; `total` is that over all. For all
// invocations together, and as often as wanted.
uint exclusiveSum(uint value, out uint total) {
  const uint thread = gl_LocalInvocationIndex;
  scanned[thread] = value;
  barrier();
  uint sum = value;
  for (uint step = 1u; step < SORT_GROUP; step *= 2u) {
    const uint before = thread >= step ? scanned[thread - step] : 0u;
    barrier();
    sum += before;
    scanned[thread] = sum;
    barrier();
  }
  total = scanned[SORT_GROUP - 1u];
  barrier();
  return sum - value;
}

#endif
