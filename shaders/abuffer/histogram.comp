#version 460
// How many pixels each interval has, so that only those with pixels are run; and which are too deep.
#include "abuffer/deep_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

shared uint pixels[MOST_INTERVALS];

void main() {
  const uint self = gl_LocalInvocationIndex;
  if (self < MOST_INTERVALS) pixels[self] = 0u;
  barrier();
  if (all(lessThan(gl_GlobalInvocationID.xy, push.frame.c.size))) {
    const uint pixel = gl_GlobalInvocationID.y * push.frame.c.size.x + gl_GlobalInvocationID.x;
    const uint count = push.counts.at[pixel];
#ifndef TRUNCATE
    if (count > push.maxFragments) appendDeep(pixel);
    else
#endif
    if (count > 0u) atomicAdd(pixels[min(intervalOf(count), push.intervalCount - 1u)], 1u);
  }
  barrier();
  if (self < push.intervalCount && pixels[self] > 0u)
    atomicAdd(push.intervals.at[self].pixels, pixels[self]);
}
