// Quads with a vertex that cannot be snapped. 3D rasterization needs no clipping, but everything else about such
// triangles differs. They are few, and are binned like large triangles. The includer declares `push`.
#ifndef OITLAB_RASTER_UNSNAPPED_GLSL
#define OITLAB_RASTER_UNSNAPPED_GLSL

#include "raster/triangles.glsl"

// Bounds of what lies behind the near plane as seen from the eye (Blinn 1996), one pixel wider for rounding errors.
ivec4 unsnappedBox(vec3 p[3], float near, uvec2 size) {
  vec2 low = vec2(1e30), high = vec2(-1e30);
  for (int i = 0; i < 3; ++i) {
    const vec3 a = p[i], b = p[i == 2 ? 0 : i + 1];
    if (a.z >= near) {
      low = min(low, a.xy / a.z);
      high = max(high, a.xy / a.z);
    }
    if ((a.z >= near) != (b.z >= near)) {
      const vec3 cut = mix(a, b, (near - a.z) / (b.z - a.z));
      low = min(low, cut.xy / near);
      high = max(high, cut.xy / near);
    }
  }
  if (low.x > high.x) return emptyBox;
  const vec2 limit = vec2(size) + 2.0;  // before the conversion to int
  return clampBox(ivec4(floor(clamp(low, vec2(-2.0), limit)) - 1.0, ceil(clamp(high, vec2(-2.0), limit)) + 1.0),
                  size);
}

void addLarge(uint slot) {
  const uint place = atomicAdd(push.counters.c.largeTriangles, 1u);
  if (place < push.largeCapacity) push.large.at[place] = slot;
  if (push.countAll != 0u) atomicAdd(push.counters.c.visibleTriangles, 1u);
}

// Lists the triangle if it is visible. Returns whether it is.
bool setUpHalf(uint slot, PackedQuad quad) {
  const uvec2 size = push.frame.c.size;
  const float near = nearPlane(push.frame.c.viewProjection);
  const uvec3 vertices = verticesOf(quad.corners, slot);
  vec3 p[3];
  ScreenVertex v[3];
  [[unroll]] for (int i = 0; i < 3; ++i) {
    p[i] = homogeneous(push.frame.c.viewProjection, size, push.mesh.vertices.at[vertices[i]].positionNormal.xyz);
    v[i] = loadVertex(push.mesh, vertices[i]);
  }
  if (snaps(v[0]) && snaps(v[1]) && snaps(v[2])) {
    const bool visible = !isEmpty(screenBox(snapped(v[0].pixel), snapped(v[1].pixel), snapped(v[2].pixel), size));
    if (visible) addLarge(slot);
    return visible;
  }
  const float facing = dot(edgePlane(p[0], p[1]), p[2]);
  const ivec4 box = facing == 0.0 ? emptyBox : unsnappedBox(p, near, size);
  if (isEmpty(box)) return false;
  const uint index = atomicAdd(push.counters.c.unsnappedTriangles, 1u);
  if (index >= push.unsnappedCapacity) return true;  // counted anyway: the host allocates more
  addLarge(UNSNAPPED | index);
  const bool flipped = facing < 0.0;
  const vec3 p1 = flipped ? p[2] : p[1], p2 = flipped ? p[1] : p[2];
  const ScreenVertex v0 = v[0], v1 = flipped ? v[2] : v[1], v2 = flipped ? v[1] : v[2];
  UnsnappedTriangle t;
  // The anchor is in the middle of what is visible, for precision.
  t.shading = unsnappedPlanes(p[0], p[1], p[2], vec2((box.xy + box.zw) / 2) + 0.5);
  fillAttributes(t.shading, slot, quad, cornersOf(slot), uvec3(v[0].normal, v[1].normal, v[2].normal));
  t.p = vec3[3](p[0], p1, p2);
  t.snapped = ivec2[3](snapped(v0.pixel), snapped(v1.pixel), snapped(v2.pixel));
  t.snaps = uint(snaps(v0)) | uint(snaps(v1)) << 1 | uint(snaps(v2)) << 2;
  const uvec4 bins = uvec4(box) / BIN_SIZE;
  t.firstBin = bins.x | bins.y << 16;
  t.lastBin = bins.z | bins.w << 16;
  push.mesh.unsnapped.at[index] = t;
  return true;
}

void setUpUnsnapped(uint number) {
  const PackedQuad quad = push.mesh.quads.at[number];
  const bool single = quad.corners.z == quad.corners.w;
  const bool visible0 = setUpHalf(2u * number, quad);
  const bool visible1 = !single && setUpHalf(2u * number + 1u, quad);
  if (!visible0 && !visible1) return;
  atomicAdd(push.counters.c.largeQuads, 1u);
  if (push.countAll != 0u && single) atomicAdd(push.counters.c.visibleDegenerate, 1u);
}

#endif
