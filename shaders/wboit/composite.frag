#version 460
// Section 4: the weighted mean colour, as visible as the revealage leaves it, over what is opaque.
#include "common/bindings.glsl"

layout(location = 0) out vec4 outColor;  // premultiplied

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const float revealage = texelFetch(methodImages[1], pixel, 0).r;
  if (revealage == 1.0) discard;  // nothing transparent here
  vec4 sum = texelFetch(methodImages[0], pixel, 0);
  // As the paper's listing does: where half floats overflowed, white is better than not a number.
  if (any(isinf(sum.rgb))) sum = vec4(1.0);
  const vec3 mean = sum.rgb / max(sum.a, 1e-5);
  outColor = vec4(mean, 1.0) * (1.0 - revealage);
}
