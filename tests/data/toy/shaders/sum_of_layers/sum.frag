#version 460
// Light adds up, whatever is in front.
#include "common/surface_input.glsl"
#include "sum_of_layers/sum_types.h"

layout(push_constant, scalar) uniform Push { SumPush push; };
layout(location = 0) out vec4 outColor;

void main() {
  vec4 color;
  if (!shade(push.frame.c.materials.at[inMaterial], surfaceInput(), color)) discard;
  outColor = vec4(push.strength * color.a * color.rgb, 0.0);
}
