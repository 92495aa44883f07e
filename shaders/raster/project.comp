#version 460
// Stage 1, before quads are set up: the vertices on the screen, one invocation each. The paper has each
// quad do its own; here all later stages read them, in place of a record of each triangle.
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
