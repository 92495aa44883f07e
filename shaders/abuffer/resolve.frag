#version 460
// The sort as a fragment shader, for the pixels that the stencil lets pass.
#include "abuffer/resolve.glsl"

layout(early_fragment_tests) in;  // a masked pixel costs nothing

void main() { resolvePixel(uint(gl_FragCoord.y) * push.frame.c.size.x + uint(gl_FragCoord.x)); }
