#version 460
// Fills the target with one colour: 32 x 32 pixels a workgroup. 8 x 4 pixels lie beside each other in
// most devices' images: 32 invocations each.
#include "common/bindings.glsl"

layout(local_size_x = 256) in;
layout(push_constant) uniform Push { vec4 color; uint firstRow; };

void main() {
  const uint self = gl_LocalInvocationIndex, block = self / 32u;
  const uvec2 inBlock = uvec2(self % 8u, self / 8u % 4u);
  const uvec2 group = gl_WorkGroupID.xy + uvec2(0u, firstRow);
  const ivec2 first = ivec2(group * 32u + uvec2(block % 4u, block / 4u) * uvec2(8u, 4u) + inBlock);
  [[unroll]] for (int row = 0; row < 32; row += 8) {
    const ivec2 pixel = first + ivec2(0, row);
    if (all(lessThan(pixel, imageSize(target)))) imageStore(target, pixel, color);
  }
}
