#version 460
// Captures every transparent fragment in front of the opaque depth into its pixel's list.
#include "common/pixel.glsl"
#include "common/surface_input.glsl"
#include "reference/lists.h"

layout(push_constant, scalar) uniform Push { ListPush push; };

// Without it the depth test would come after the stores below. Helper invocations need no care: their
// stores and atomics have no effect.
layout(early_fragment_tests) in;

void main() {
  vec4 color;
  if (!shade(push.frame.c.materials.at[inMaterial], surfaceInput(), color)) return;
  const uint index = atomicAdd(push.counters.c.fragments, 1u);
  if (index >= push.capacity) return;  // counted all the same: the host grows the pool
  linkFragment(push.nodes, push.heads, pixelIndex(push.frame.c.size), index, color, gl_FragCoord.z,
               push.frame.c.transparentIds.at[gl_PrimitiveID]);
}
