#version 460
// Section 3, step 2b: marks the pixels of one interval in the stencil. The reference value is the
// interval's own, so that the stencil need not be cleared between intervals.
#include "abuffer/abuffer_types.h"
#include "common/pixel.glsl"

void main() {
  const uint count = push.counts.at[pixelIndex(push.frame.c.size)];
  if (count <= push.low || count > push.high) discard;
}
