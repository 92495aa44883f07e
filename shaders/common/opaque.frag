#version 460
// The opaque pass: OPAQUE and MASK materials, before any transparent fragment.
#include "common/surface_input.glsl"

layout(push_constant, scalar) uniform Push { FrameBuffer frame; };
layout(location = 0) out vec4 outColor;

void main() {
  vec4 color;
  if (!shade(frame.c.materials.at[inMaterial], surfaceInput(), color)) discard;
  outColor = vec4(color.rgb, 1.0);
}
