// What becomes of a pixel that is sorted and blended.
//
// One shader for all pixels (DIRECT) writes the target at once. Shaders for intervals leave the
// result in the pixel's first node, whose fragment is done with, and composite.comp takes it to the
// target: so none of them has to wait for another, as it would have to between writes of one image.
#ifndef OITLAB_ABUFFER_FINISH_GLSL
#define OITLAB_ABUFFER_FINISH_GLSL

#include "abuffer/abuffer_types.h"
#include "common/bindings.glsl"
#include "common/order.glsl"

// A node of every colour format has the 16 bytes of a result.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ResultReference { vec4 color; };

ResultReference resultIn(uint node) {
#if NODE_COLOR == 1
  const uint nodeBytes = 20u;
#elif NODE_COLOR == 2
  const uint nodeBytes = 16u;
#else
  const uint nodeBytes = 28u;
#endif
  return ResultReference(uint64_t(push.nodes) + uint64_t(node) * nodeBytes);
}

// `accumulated`: the blended fragments, premultiplied. `head`: the pixel's first node.
void finishPixel(uint pixel, uint head, vec4 accumulated, Tally tally) {
#ifdef DIRECT
  const ivec2 at = ivec2(pixel % push.frame.c.size.x, pixel / push.frame.c.size.x);
  imageStore(target, at, overOpaque(accumulated, imageLoad(target, at)));
#else
  resultIn(head).color = accumulated;
#endif
  if (push.counting != 0u) push.tallies.at[pixel] = tally;
}

#endif
