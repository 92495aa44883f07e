#version 460
// The results of the intervals (finish.glsl) over the opaque colour.
#include "abuffer/finish.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.frame.c.size))) return;
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  const uint head = push.heads.at[gl_GlobalInvocationID.y * push.frame.c.size.x + gl_GlobalInvocationID.x];
  if (head == LIST_END) return;
  imageStore(target, at, overOpaque(resultIn(head).color, imageLoad(target, at)));
}
