#version 460
// The sort as a fragment shader, for the pixels that pass the stencil test. Helper invocations for the other pixels
// of a quad run this too. They store nothing, but they walk lists that may already hold results (finish.glsl), so
// every address that they load from must lie in the buffer.
#define HELPERS
#include "abuffer/resolve.glsl"
#include "common/pixel.glsl"

layout(early_fragment_tests) in;  // a masked pixel costs nothing

void main() { resolvePixel(pixelIndex(push.frame.c.size)); }
