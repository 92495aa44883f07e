#version 460
// Section 3, step 2b: marks the pixels of one interval in the stencil. The reference value is the
// interval's own, so that the stencil need not be cleared between intervals.
#include "abuffer/abuffer_types.h"

void main() {
  const uint count =
      push.counts.at[uint(gl_FragCoord.y) * push.frame.c.size.x + uint(gl_FragCoord.x)];
  if (count <= push.low || count > push.high) discard;
}
