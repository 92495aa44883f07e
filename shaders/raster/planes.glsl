// The functions of a triangle that are linear on the screen: 1 / w, and the barycentric weights over w.
#ifndef OITLAB_RASTER_PLANES_GLSL
#define OITLAB_RASTER_PLANES_GLSL

#include "raster/project.glsl"

// A corner of a triangle: a ScreenVertex in one word, and its number in the quad.
struct PlaneCorner {
  vec4 vertex;
  uint number;
};

// Orders corners by distance, then by place.
bool comesFirst(PlaneCorner a, PlaneCorner b) {
  if (a.vertex.z != b.vertex.z) return a.vertex.z > b.vertex.z;
  if (a.vertex.x != b.vertex.x) return a.vertex.x < b.vertex.x;
  return a.vertex.y < b.vertex.y;
}

void order(inout PlaneCorner a, inout PlaneCorner b) {
  const bool swap = comesFirst(b, a);
  const PlaneCorner c = a;
  a.vertex = swap ? b.vertex : a.vertex;
  a.number = swap ? b.number : a.number;
  b.vertex = swap ? c.vertex : b.vertex;
  b.number = swap ? c.number : b.number;
}

// Gradient of a function that is 0 at the first corner, and f1 and f2 at the others, which lie at d1 and d2 from the
// first. overArea: 1 / (twice the area), so that all gradients of a triangle share one division.
vec2 gradient(vec2 d1, vec2 d2, float f1, float f2, float overArea) {
  precise vec2 g;
  g.x = (f1 * d2.y - f2 * d1.y) * overArea;
  g.y = (f2 * d1.x - f1 * d2.x) * overArea;
  return g;
}

// The planes of three corners that snap. Sets nothing else. Puts the nearest corner first, so that triangles on the
// same three points have the same depths, whatever the order of their corners. (The order of the other two does not
// matter: it only changes signs, and rounding is symmetric.)
ShadeTriangle snappedPlanes(inout PlaneCorner first, inout PlaneCorner second, inout PlaneCorner third) {
  order(first, second);
  order(first, third);
  const vec3 a = first.vertex.xyz, b = second.vertex.xyz, c = third.vertex.xyz;
  ShadeTriangle t;
  precise const vec2 d1 = b.xy - a.xy;
  precise const vec2 d2 = c.xy - a.xy;
  precise const float area = d1.x * d2.y - d1.y * d2.x;
  t.anchor = a.xy;
  t.minInvW = min(b.z, c.z);
  t.invW = a.z;
  t.weights = vec2(0.0);
  // Thinner than rounding errors: the attributes of the nearest corner everywhere.
  const bool flat_ = area == 0.0;
  precise const float overArea = 1.0 / area;
  precise const float rise1 = b.z - a.z;
  precise const float rise2 = c.z - a.z;
  t.invWSlope = flat_ ? vec2(0.0) : gradient(d1, d2, rise1, rise2, overArea);
  t.b1Slope = flat_ ? vec2(0.0) : gradient(d1, d2, b.z, 0.0, overArea);
  t.b2Slope = flat_ ? vec2(0.0) : gradient(d1, d2, 0.0, c.z, overArea);
  return t;
}

// The planes of homogeneous corners anywhere, from the inverse of the matrix (a b c) (Olano and Greer 1997). `anchor`:
// a pixel that the triangle covers or that is near it.
ShadeTriangle unsnappedPlanes(vec3 a, vec3 b, vec3 c, vec2 anchor) {
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
  t.weights = vec2(b1.z, b2.z);
  return t;
}

#endif
