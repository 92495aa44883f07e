#version 460
// Adds one for every transparent fragment in front of the opaque depth: those that methods blend.
#include "common/pixel.glsl"
#include "common/surface_input.glsl"
#include "depth/count.h"

layout(push_constant, scalar) uniform Push { CountPush push; };

// As in every capture: without it the depth test would come after the atomic.
layout(early_fragment_tests) in;

void main() {
  vec4 color;
  // Only whether the fragment is there at all is of interest: alpha may cut it away.
  if (!shade(push.frame.c.materials.at[inMaterial], surfaceInput(), color)) return;
  atomicAdd(push.counts.at[pixelIndex(push.frame.c.size)], 1u);
}
