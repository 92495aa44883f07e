#version 460
// Stage 1, before quad setup: projects the vertices, one invocation per vertex. In the paper, each quad projects its
// own. Here all later stages read the projected vertices instead of one record per triangle.
#include "raster/project.glsl"

layout(local_size_x = SETUP_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

void main() {
  const uint i = gl_WorkGroupID.y * MAX_GROUPS * SETUP_GROUP + gl_GlobalInvocationID.x;
  if (i >= push.vertexCount) return;
  const mat4 viewProjection = push.frame.c.viewProjection;
  const vec4 word = push.mesh.vertices.at[i].positionNormal;
  const vec3 p = homogeneous(viewProjection, push.frame.c.size, word.xyz);
  const ScreenVertex v = toScreen(p, nearPlane(viewProjection), floatBitsToUint(word.w));
  push.mesh.onScreen.at[i] = vec4(v.pixel, v.invW, uintBitsToFloat(v.normal));
}
