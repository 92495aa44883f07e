#version 460
// The sort as a compute shader: for all pixels, or (LISTED) for the list of an interval.
#include "abuffer/resolve.glsl"

#ifdef LISTED
layout(local_size_x = LIST_GROUP) in;

void main() {
  const uint index = indexInList(gl_WorkGroupID, gl_LocalInvocationIndex);
  if (index < push.intervals.at[push.interval].pixels)
    resolvePixel(push.lists.at[push.intervals.at[push.interval].begin + index]);
}
#else
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  if (all(lessThan(gl_GlobalInvocationID.xy, push.frame.c.size)))
    resolvePixel(gl_GlobalInvocationID.y * push.frame.c.size.x + gl_GlobalInvocationID.x);
}
#endif
