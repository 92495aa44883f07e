#version 460
// Section 4: premultiplied colour and alpha, weighted, are summed up in one target; the product of
// (1 - alpha), the revealage, in another. Both blend in any order.
#include "common/surface_input.glsl"
#include "wboit/weight.glsl"
#include "wboit/wboit_types.h"

layout(push_constant, scalar) uniform Push { WboitPush push; };
layout(location = 0) out vec4 outAccumulated;
layout(location = 1) out float outRevealage;

void main() {
  vec4 color;
  if (!shade(push.frame.c.materials.at[inMaterial], surfaceInput(), color)) discard;
  const float z = 1.0 / gl_FragCoord.w;  // clip w is the distance from the eye plane
  const float range = max(push.farthest - push.nearest, 1e-20);
  // As the depth buffer of a projection onto [nearest, farthest] has it (the paper's d(z)).
  const float d = clamp(push.farthest * (z - push.nearest) / (z * range), 0.0, 1.0);
  const float w = weight(z * push.depthScale, d, color.a);
  outAccumulated = vec4(color.rgb * color.a, color.a) * w;
  outRevealage = color.a;  // blended as destination * (1 - source)
}
