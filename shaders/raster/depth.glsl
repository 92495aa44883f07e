// The depth of a triangle at a pixel. The opaque pass and all users of the compute rasterizer take it from here: a
// function of the triangle and the pixel alone, so that an opaque triangle and its transparent copy have equal depths.
#ifndef OITLAB_RASTER_DEPTH_GLSL
#define OITLAB_RASTER_DEPTH_GLSL

#include "raster/planes.glsl"

// 1 / w at the half-block's first sample, and at a pixel of it. `precise`, because the order of fragments must be the
// same in every shader. Slivers have steep planes, so 1 / w is clamped to the range of the corners.
float originInvW(ShadeTriangle s, ivec2 corner) {
  const vec2 d = vec2(corner) + 0.5 - s.anchor;
  precise const float invW = fma(s.invWSlope.x, d.x, fma(s.invWSlope.y, d.y, s.invW));
  return invW;
}

float planeInvW(float origin, vec2 slope, float low, float high, vec2 pixel) {
  precise const float invW = fma(slope.x, pixel.x, fma(slope.y, pixel.y, origin));
  return clamp(invW, low, high);
}

vec2 boundsOfInvW(ShadeTriangle s) {
  return s.minInvW >= 0.0 ? vec2(s.minInvW, s.invW) : vec2(0.0, uintBitsToFloat(0x7f7fffffu));
}

float boundedInvW(float origin, ShadeTriangle s, vec2 pixel) {
  const vec2 bounds = boundsOfInvW(s);
  return planeInvW(origin, s.invWSlope, bounds.x, bounds.y, pixel);
}

// Reversed depth: near / distance. It is what fragments are ordered by and what the opaque depth is compared with.
float depthOf(float near, float invW) {
  precise const float depth = near * invW;
  return depth;
}

float depthOf(FrameBuffer frame, float invW) { return depthOf(frame.c.viewProjection[3][2], invW); }

#endif
