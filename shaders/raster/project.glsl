// Vertices on the screen.
#ifndef OITLAB_RASTER_PROJECT_GLSL
#define OITLAB_RASTER_PROJECT_GLSL

#include "raster/raster_types.h"

struct Corner {
  vec3 p;         // homogeneous pixels: p.xy / p.z is the place on the screen, p.z the distance
  vec2 pixel;     // where it snaps
  float invW;     // 1 / distance
  ivec2 snapped;  // 1/256 pixel
  bool snaps;     // not nearer than the near plane and within the guard band
};

float nearPlane(mat4 viewProjection) { return viewProjection[3][2]; }

// The same position must come to the same bits in every triangle that has it: `precise`.
Corner project(mat4 viewProjection, uvec2 size, vec3 position) {
  Corner c;
  precise const vec4 clip = viewProjection * vec4(position, 1.0);
  const vec2 halfSize = 0.5 * vec2(size);
  precise const vec2 pixels = halfSize * (clip.xy + clip.w);
  c.p = vec3(pixels, clip.w);
  precise const float invW = 1.0 / clip.w;
  precise const vec2 pixel = pixels * invW;
  const float limit = float(GUARD_BAND >> SUBPIXEL_BITS);
  c.snaps = clip.w >= nearPlane(viewProjection) && all(lessThan(abs(pixel), vec2(limit)));
  c.invW = invW;
  c.pixel = pixel;
  c.snapped = c.snaps ? ivec2(roundEven(pixel * float(1 << SUBPIXEL_BITS))) : ivec2(0);
  return c;
}

int64_t signedArea(ivec2 a, ivec2 b, ivec2 c) {
  const ivec2 u = b - a, v = c - a;
  return int64_t(u.x) * v.y - int64_t(u.y) * v.x;
}

// The cross product that 3D edge functions are made of. `precise`, so that swapping a and b swaps
// exactly the sign, and triangles on both sides of an edge agree.
vec3 edgePlane(vec3 a, vec3 b) {
  precise vec3 n;
  n.x = a.y * b.z - a.z * b.y;
  n.y = a.z * b.x - a.x * b.z;
  n.z = a.x * b.y - a.y * b.x;
  return n;
}

// Inclusive range of pixels (x0, y0, x1, y1) whose centres a triangle may cover; empty where a first
// exceeds its last: what falls between samples is culled by that (Laine and Karras 2011).
const ivec4 emptyBox = ivec4(1, 1, 0, 0);

ivec4 clampBox(ivec4 box, uvec2 size) {
  return ivec4(max(box.xy, ivec2(0)), min(box.zw, ivec2(size) - 1));
}

ivec4 snappedBox(ivec2 a, ivec2 b, ivec2 c) {
  const ivec2 low = min(min(a, b), c), high = max(max(a, b), c);
  const int half_ = 1 << (SUBPIXEL_BITS - 1);
  return ivec4((low + half_ - 1) >> SUBPIXEL_BITS, (high - half_) >> SUBPIXEL_BITS);
}

// Bounds of the part in front of the near plane (Blinn 1996), a pixel wider for rounding.
ivec4 irregularBox(vec3 a, vec3 b, vec3 c, float near, uvec2 size) {
  vec2 low = vec2(1e30), high = vec2(-1e30);
  const vec3 corners[4] = vec3[4](a, b, c, a);
  for (int i = 0; i < 3; ++i) {
    const vec3 p = corners[i], q = corners[i + 1];
    if (p.z >= near) {
      low = min(low, p.xy / p.z);
      high = max(high, p.xy / p.z);
    }
    if ((p.z >= near) != (q.z >= near)) {
      const vec3 cut = mix(p, q, (near - p.z) / (q.z - p.z));
      low = min(low, cut.xy / near);
      high = max(high, cut.xy / near);
    }
  }
  if (low.x > high.x) return emptyBox;
  const vec2 limit = vec2(size) + 2.0;  // before the conversion to int
  return ivec4(floor(clamp(low, vec2(-2.0), limit)) - 1.0, ceil(clamp(high, vec2(-2.0), limit)) + 1.0);
}

// The pixels of a triangle on the screen.
ivec4 triangleBox(Corner a, Corner b, Corner c, float near, uvec2 size) {
  if (a.snaps && b.snaps && c.snaps) {
    if (signedArea(a.snapped, b.snapped, c.snapped) == 0) return emptyBox;
    return clampBox(snappedBox(a.snapped, b.snapped, c.snapped), size);
  }
  if (dot(edgePlane(a.p, b.p), c.p) == 0.0) return emptyBox;
  return clampBox(irregularBox(a.p, b.p, c.p, near, size), size);
}

bool isEmpty(ivec4 box) { return box.x > box.z || box.y > box.w; }

#endif
