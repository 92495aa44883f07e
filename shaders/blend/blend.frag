#version 460
// Hardware alpha blending: the fragment's straight colour; the blend unit does `over`.
#include "common/surface_input.glsl"

layout(push_constant, scalar) uniform Push { FrameBuffer frame; };
layout(location = 0) out vec4 outColor;

void main() {
  vec4 color;
  if (!shade(frame.c.materials.at[inMaterial], surfaceInput(), color)) discard;
  outColor = color;
}
