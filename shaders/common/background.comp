#version 460
// Fills the target with one colour: 32 x 32 pixels a workgroup.
#include "common/bindings.glsl"

layout(local_size_x = 32, local_size_y = 8) in;
layout(push_constant) uniform Push { vec4 color; uint firstRow; };

void main() {
  const uvec2 group = gl_WorkGroupID.xy + uvec2(0u, firstRow);
  const ivec2 first = ivec2(group * 32u + gl_LocalInvocationID.xy);
  [[unroll]] for (int row = 0; row < 32; row += 8) {
    const ivec2 pixel = first + ivec2(0, row);
    if (all(lessThan(pixel, imageSize(target)))) imageStore(target, pixel, color);
  }
}
