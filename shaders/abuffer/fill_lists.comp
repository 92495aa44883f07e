#version 460
// The lists of pixels by interval: the paper's alternative to the stencil. The order within a list is
// by chance, and nothing depends on it; blocks of 8x8 pixels stay together.
#include "abuffer/abuffer_types.h"

layout(local_size_x = 8, local_size_y = 8) in;

shared uint places[MOST_INTERVALS];  // counts, then where the block's pixels begin

void main() {
  const uint self = gl_LocalInvocationIndex;
  if (self < MOST_INTERVALS) places[self] = 0u;
  barrier();
  uint interval = MOST_INTERVALS, place = 0u;
  const uint pixel = gl_GlobalInvocationID.y * push.frame.c.size.x + gl_GlobalInvocationID.x;
  if (all(lessThan(gl_GlobalInvocationID.xy, push.frame.c.size))) {
    const uint count = push.counts.at[pixel];
#ifdef TRUNCATE
    const bool listed = count > 0u;
#else
    const bool listed = count > 0u && count <= push.maxFragments;
#endif
    if (listed) {
      interval = min(intervalOf(count), push.intervalCount - 1u);
      place = atomicAdd(places[interval], 1u);
    }
  }
  barrier();
  if (self < push.intervalCount && places[self] > 0u)
    places[self] = atomicAdd(push.intervals.at[self].cursor, places[self]);
  barrier();
  if (interval < MOST_INTERVALS) push.lists.at[places[interval] + place] = pixel;
}
