// What is linear on the screen over a triangle: 1 / w, and the barycentric weights over w.
#ifndef OITLAB_RASTER_PLANES_GLSL
#define OITLAB_RASTER_PLANES_GLSL

#include "raster/project.glsl"

// Nearer first, then by place: an order of the corners that does not depend on the order in which
// the triangle lists them, so that triangles on the same three points get the same depths.
bool comesFirst(Corner a, Corner b) {
  if (a.invW != b.invW) return a.invW > b.invW;
  if (a.pixel.x != b.pixel.x) return a.pixel.x < b.pixel.x;
  return a.pixel.y < b.pixel.y;
}

void swapCorners(inout Corner a, inout Corner b, inout uint ia, inout uint ib) {
  const Corner c = a;
  a = b;
  b = c;
  const uint i = ia;
  ia = ib;
  ib = i;
}

// Gradient of a function that is 0 at the first corner, f1 and f2 at the others; d1 and d2 lead to
// these. One division for all gradients of a triangle.
vec2 gradient(vec2 d1, vec2 d2, float f1, float f2, float overArea) {
  precise vec2 g;
  g.x = (f1 * d2.y - f2 * d1.y) * overArea;
  g.y = (f2 * d1.x - f1 * d2.x) * overArea;
  return g;
}

// The planes of three corners that snap; the rest of the record is left open. `corners`: their numbers
// in the quad, reordered as the planes want it.
ShadeTriangle regularPlanes(Corner a, Corner b, Corner c, inout uvec3 corners) {
  if (comesFirst(b, a)) swapCorners(a, b, corners.x, corners.y);
  if (comesFirst(c, b)) swapCorners(b, c, corners.y, corners.z);
  if (comesFirst(b, a)) swapCorners(a, b, corners.x, corners.y);
  ShadeTriangle t;
  precise const vec2 d1 = b.pixel - a.pixel;
  precise const vec2 d2 = c.pixel - a.pixel;
  precise const float area = d1.x * d2.y - d1.y * d2.x;
  t.anchor = a.pixel;
  t.minInvW = c.invW;
  t.invW = a.invW;
  // Thinner than rounding: the nearest corner's attributes throughout.
  const bool flat_ = area == 0.0;
  precise const float overArea = 1.0 / area;
  precise const float rise1 = b.invW - a.invW;
  precise const float rise2 = c.invW - a.invW;
  t.invWSlope = flat_ ? vec2(0.0) : gradient(d1, d2, rise1, rise2, overArea);
  t.b1Slope = flat_ ? vec2(0.0) : gradient(d1, d2, b.invW, 0.0, overArea);
  t.b2Slope = flat_ ? vec2(0.0) : gradient(d1, d2, 0.0, c.invW, overArea);
  return t;
}

// Of homogeneous corners, wherever they are: the inverse of the matrix (a b c) (Olano and Greer
// 1997). `anchor`: a pixel that the triangle covers or is near. `atAnchor`: both weights there.
ShadeTriangle irregularPlanes(vec3 a, vec3 b, vec3 c, vec2 anchor, out vec2 atAnchor) {
  a.xy -= anchor * a.z;
  b.xy -= anchor * b.z;
  c.xy -= anchor * c.z;
  const vec3 ea = edgePlane(b, c), eb = edgePlane(c, a), ec = edgePlane(a, b);
  const float det = dot(a, ea);
  const vec3 invW = (ea + eb + ec) / det, b1 = eb / det, b2 = ec / det;
  ShadeTriangle t;
  t.anchor = anchor;
  t.minInvW = -1.0;
  t.invW = invW.z;
  t.invWSlope = invW.xy;
  t.b1Slope = b1.xy;
  t.b2Slope = b2.xy;
  atAnchor = vec2(b1.z, b2.z);
  return t;
}

#endif
