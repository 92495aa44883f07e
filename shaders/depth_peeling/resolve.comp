#version 460
// What was peeled, over the opaque colour. Fragments peeled from the back follow those from the front:
// from their lists one after the other, rounded as every exact method rounds, or as the one colour
// that they were blended to (Bavoil and Myers 2008).
#include "common/bindings.glsl"
#include "common/order.glsl"
#include "depth_peeling/peel_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { PeelPush push; };

void main() {
  const uvec2 at = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(at, push.frame.c.size))) return;
  const uint pixel = at.y * push.frame.c.size.x + at.x;
  vec4 accumulated = push.front.at[pixel];
#ifdef BACK_LIST
  // An overflowed list is recorded again, and its gaps are not walked. A pixel has as many nodes here
  // as there are passes: less than the 65,535 iterations that llvmpipe allows (maxPasses in C++).
  if (push.counters.c.back <= push.capacity) {
    uint node = push.heads.at[pixel], left = push.counters.c.back;
    for (; node != LIST_END && left > 0u; --left) {
      accumulated = blendUnder(accumulated, push.listed.at[node].color);
      node = push.listed.at[node].next;
    }
    if (node != LIST_END) atomicAdd(push.counters.c.broken, 1u);
  }
#endif
#ifdef BACK_BLEND
  accumulated += (1.0 - accumulated.a) * push.back.at[pixel];
#endif
  if (accumulated == vec4(0.0)) return;  // nothing there
  const ivec2 place = ivec2(at);
  imageStore(target, place, overOpaque(accumulated, imageLoad(target, place)));
}
