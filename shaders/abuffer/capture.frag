#version 460
// Section 2: every transparent fragment in front of the opaque depth goes into its pixel's list.
// COUNTS: it is counted for its pixel too, which the intervals of section 3 need.
#include "common/pixel.glsl"
#include "common/surface_input.glsl"
#include "abuffer/abuffer_types.h"

// Without it the depth test would come after the stores below. (A stencil that counts is incremented
// before the cutoff of alpha, then, and may count too many: see find_deep.frag.)
layout(early_fragment_tests) in;

void main() {
  vec4 color;
  if (!shade(push.frame.c.materials.at[inMaterial], surfaceInput(), color)) return;
  const uint index = atomicAdd(push.counters.c.fragments, 1u);
  if (index >= push.capacity) return;  // counted all the same: the host grows the pool, or says so
  const uint pixel = pixelIndex(push.frame.c.size);
  linkFragment(push.nodes, push.heads, pixel, index, color, gl_FragCoord.z,
               push.frame.c.transparentIds.at[gl_PrimitiveID]);
#ifdef COUNTS
  atomicAdd(push.counts.at[pixel], 1u);
#endif
}
