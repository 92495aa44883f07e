#version 460
// The vertex stage of every method that uses the hardware rasterizer. The index buffer is bound, so
// the post-transform cache works as usual; attributes are read by address.
#include "common/frame_types.h"
#include "common/normal.glsl"

layout(push_constant, scalar) uniform Push { FrameBuffer frame; };

layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec2 outUv;
layout(location = 2) out vec4 outColor;
layout(location = 3) flat out uint outMaterial;

void main() {
  const Vertex v = frame.c.vertices.at[gl_VertexIndex];
  // The opaque pass and each method's pass must produce the same depths, however they are compiled.
  precise const vec4 position = frame.c.viewProjection * vec4(v.position, 1.0);
  gl_Position = position;
  outNormal = unpackNormal(v.normal);
  outUv = v.uv;
  outColor = unpackUnorm4x8(v.color);
  outMaterial = v.material;
}
