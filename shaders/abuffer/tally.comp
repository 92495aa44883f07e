#version 460
// Adds up the tallies of all pixels: instrumented frames only, in a stage of its own, so that
// counting is in no time that is reported.
#include "abuffer/abuffer_types.h"

layout(local_size_x = 8, local_size_y = 8) in;

shared uint blended, deepest, covered, truncatedPixels, truncatedFragments, pixels[BINS];

void main() {
  const uint self = gl_LocalInvocationIndex;
  if (self == 0u) blended = deepest = covered = truncatedPixels = truncatedFragments = 0u;
  if (self < BINS) pixels[self] = 0u;
  barrier();
  if (all(lessThan(gl_GlobalInvocationID.xy, push.frame.c.size))) {
    const Tally tally =
        push.tallies.at[gl_GlobalInvocationID.y * push.frame.c.size.x + gl_GlobalInvocationID.x];
    const uint count = tally.blended + tally.leftOut;
    if (count > 0u) {
      atomicAdd(blended, tally.blended);
      atomicMax(deepest, count);
      atomicAdd(covered, 1u);
      atomicAdd(pixels[min(intervalOf(count), BINS - 1u)], 1u);
    }
    if (tally.leftOut > 0u) {
      atomicAdd(truncatedPixels, 1u);
      atomicAdd(truncatedFragments, tally.leftOut);
    }
  }
  barrier();
  if (covered == 0u) return;
  if (self < BINS && pixels[self] > 0u) atomicAdd(push.counters.c.pixels[self], pixels[self]);
  if (self > 0u) return;
  atomicAdd(push.counters.c.blended, blended);
  atomicMax(push.counters.c.deepest, deepest);
  atomicAdd(push.counters.c.covered, covered);
  atomicAdd(push.counters.c.truncatedPixels, truncatedPixels);
  atomicAdd(push.counters.c.truncatedFragments, truncatedFragments);
}
