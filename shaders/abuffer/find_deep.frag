#version 460
// With a stencil that counts: lists the pixels whose stencil is beyond the last interval. A stencil
// stops at 255, so these may have any number of fragments (and fewer, where alpha was cut off after
// the stencil had counted); deep.comp takes lists of any length.
#include "abuffer/deep_list.glsl"
#include "common/pixel.glsl"

layout(early_fragment_tests) in;

void main() {
  const uint pixel = pixelIndex(push.frame.c.size);
  if (push.heads.at[pixel] != LIST_END) appendDeep(pixel);
}
