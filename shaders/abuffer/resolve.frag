#version 460
// The sort as a fragment shader, for the pixels that the stencil lets pass. Helper invocations stand in
// for their neighbours in the quad and come here too: they store nothing, but they walk lists, which
// may have become results (finish.glsl).
#include "abuffer/resolve.glsl"
#include "common/pixel.glsl"

layout(early_fragment_tests) in;  // a masked pixel costs nothing

void main() { resolvePixel(pixelIndex(push.frame.c.size)); }
