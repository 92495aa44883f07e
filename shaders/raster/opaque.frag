#version 460
// The opaque pass of methods that use the compute rasterizer. It does what common/opaque.frag does, and writes the depth
// that the compute rasterizer finds for a copy of this triangle at this pixel. What the hardware interpolates differs
// from that in the last bits, and fragments on an opaque surface would be taken for hidden ones.
#include "common/surface_input.glsl"
#include "raster/blocks/block_types.h"
#include "raster/depth.glsl"

layout(push_constant, scalar) uniform Push { FrameBuffer frame; UintBuffer indices; };
layout(location = 0) out vec4 outColor;
layout(location = 1) out float outDepth;

// Of a triangle that cannot be snapped it is the hardware's: the plane of such a triangle depends on what is visible of
// it (raster/unsnapped.glsl).
float depthHere() {
  // The whole matrix is loaded: here, llvmpipe (Mesa 22.3) reads 0 where only viewProjection[3][2] is asked for.
  const mat4 viewProjection = frame.c.viewProjection;
  const float near = nearPlane(viewProjection);
  PlaneCorner corners[3];
  bool allSnap = true;
  [[unroll]] for (uint i = 0u; i < 3u; ++i) {
    const uint vertex = indices.at[3u * uint(gl_PrimitiveID) + i];
    const vec3 p = homogeneous(viewProjection, frame.c.size, frame.c.vertices.at[vertex].position);
    const ScreenVertex v = toScreen(p, near, 0u);
    corners[i] = PlaneCorner(vec4(v.pixel, v.invW, 0.0), i);
    allSnap = allSnap && snaps(v);
  }
  if (!allSnap) return gl_FragCoord.z;
  const ShadeTriangle s = snappedPlanes(corners[0], corners[1], corners[2]);
  const uvec2 pixel = uvec2(gl_FragCoord.xy), inBlock = pixel % uvec2(HALF_BLOCK_WIDTH, HALF_BLOCK_HEIGHT);
  return depthOf(near, boundedInvW(originInvW(s, ivec2(pixel - inBlock)), s, vec2(inBlock)));
}

void main() {
  vec4 color;
  if (!shade(frame.c.materials.at[inMaterial], surfaceInput(), color)) discard;
  outColor = vec4(color.rgb, 1.0);
  outDepth = depthHere();
}
