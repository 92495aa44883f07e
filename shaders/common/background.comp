#version 460
// Fills the target with one colour.
#include "common/bindings.glsl"

layout(local_size_x = 32, local_size_y = 8) in;
layout(push_constant) uniform Push { vec4 color; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(pixel, imageSize(target)))) imageStore(target, pixel, color);
}
