// Vertices on the screen.
#ifndef OITLAB_RASTER_PROJECT_GLSL
#define OITLAB_RASTER_PROJECT_GLSL

#include "raster/raster_types.h"

float nearPlane(mat4 viewProjection) { return viewProjection[3][2]; }

// Homogeneous pixels: xy / z is the place on the screen, z the distance. `precise`, because a position must give the
// same bits in every triangle that has it.
vec3 homogeneous(mat4 viewProjection, uvec2 size, vec3 position) {
  precise const vec4 clip = viewProjection * vec4(position, 1.0);
  const vec2 halfSize = 0.5 * vec2(size);
  precise const vec2 pixels = halfSize * (clip.xy + clip.w);
  return vec3(pixels, clip.w);
}

ScreenVertex toScreen(vec3 p, float near, uint normal) {
  ScreenVertex v;
  precise const float invW = 1.0 / p.z;
  precise const vec2 pixel = p.xy * invW;
  const bool inBand = all(lessThan(abs(pixel), vec2(float(GUARD_BAND >> SUBPIXEL_BITS))));
  v.pixel = pixel;
  v.invW = p.z < near ? 0.0 : inBand ? invW : -invW;
  v.normal = normal;
  return v;
}

bool snaps(ScreenVertex v) { return v.invW > 0.0; }

// In 1/256 pixel. Only for vertices that snap.
ivec2 snapped(vec2 pixel) { return ivec2(roundEven(pixel * float(1 << SUBPIXEL_BITS))); }

int64_t signedArea(ivec2 a, ivec2 b, ivec2 c) {
  const ivec2 u = b - a, v = c - a;
  return int64_t(u.x) * v.y - int64_t(u.y) * v.x;
}

// The cross product that defines a 3D edge function. `precise`, so that swapping a and b changes only the sign, and
// triangles on both sides of an edge agree.
vec3 edgePlane(vec3 a, vec3 b) {
  precise vec3 n;
  n.x = a.y * b.z - a.z * b.y;
  n.y = a.z * b.x - a.x * b.z;
  n.z = a.x * b.y - a.y * b.x;
  return n;
}

// Whether a triangle faces away, tested in world space as in the paper: the eye is the intersection of the planes x, y
// and w of clip space.
bool facesAway(vec3 a, vec3 b, vec3 c) { return dot(edgePlane(a, b), c) > 0.0; }

// Inclusive range of pixels (x0, y0, x1, y1) whose centers a triangle may cover. It is empty if a first value exceeds
// its last, which culls triangles that fall between samples (Laine and Karras 2011).
const ivec4 emptyBox = ivec4(1, 1, 0, 0);

bool isEmpty(ivec4 box) { return box.x > box.z || box.y > box.w; }

ivec4 clampBox(ivec4 box, uvec2 size) {
  return ivec4(max(box.xy, ivec2(0)), min(box.zw, ivec2(size) - 1));
}

ivec4 snappedBox(ivec2 a, ivec2 b, ivec2 c) {
  const ivec2 low = min(min(a, b), c), high = max(max(a, b), c);
  const int half_ = 1 << (SUBPIXEL_BITS - 1);
  return ivec4((low + half_ - 1) >> SUBPIXEL_BITS, (high - half_) >> SUBPIXEL_BITS);
}

// The pixels of a snapped triangle on the screen.
ivec4 screenBox(ivec2 a, ivec2 b, ivec2 c, uvec2 size) {
  return signedArea(a, b, c) == 0 ? emptyBox : clampBox(snappedBox(a, b, c), size);
}

#endif
