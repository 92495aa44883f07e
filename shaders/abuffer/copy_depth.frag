#version 460
// The opaque depth, bit by bit, into the method's own depth and stencil image: Vulkan takes both from
// one image, and the captured fragments are to be tested against the one and counted in the other.
#include "common/bindings.glsl"

void main() { gl_FragDepth = texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r; }
