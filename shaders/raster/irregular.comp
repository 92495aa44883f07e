#version 460
// Stage 1, quads of which a vertex cannot be snapped: one invocation each. 3D rasterization needs no
// clipping, but everything else about such triangles differs; they are few, and a program of their own
// keeps setup.comp lean. Whether small or not, they are binned as large.
#include "raster/records.glsl"

layout(local_size_x = IRREGULAR_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

// Bounds of the part in front of the near plane (Blinn 1996), a pixel wider for rounding.
ivec4 irregularBox(vec3 p[3], float near, uvec2 size) {
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

// Whether the triangle is visible.
bool setUp(uint slot, uint index, PackedQuad quad, float near, uvec2 size) {
  const uvec3 vertices = verticesOf(quad.corners, slot), numbers = cornersOf(slot);
  vec3 p[3];
  ScreenVertex v[3];
  [[unroll]] for (int i = 0; i < 3; ++i) {
    p[i] = homogeneous(push.frame.c.viewProjection, size, push.mesh.vertices.at[vertices[i]].positionNormal.xyz);
    v[i] = loadVertex(push.mesh, vertices[i]);
  }
  if (snaps(v[0]) && snaps(v[1]) && snaps(v[2])) {
    const bool visible = !isEmpty(regularBox(snapped(v[0].pixel), snapped(v[1].pixel), snapped(v[2].pixel), size));
    if (visible) addLarge(slot);
    return visible;
  }
  const float facing = dot(edgePlane(p[0], p[1]), p[2]);
  const ivec4 box = facing == 0.0 ? emptyBox : irregularBox(p, near, size);
  if (isEmpty(box)) return false;
  IrregularTriangle t;
  // The anchor lies amid the visible part: farther away it would cost precision.
  t.shading = irregularPlanes(p[0], p[1], p[2], vec2((box.xy + box.zw) / 2) + 0.5);
  describe(t.shading, slot, quad, numbers, uvec3(v[0].normal, v[1].normal, v[2].normal));
  const int second = facing > 0.0 ? 1 : 2, third = 3 - second;
  t.p = vec3[3](p[0], p[second], p[third]);
  t.snapped = ivec2[3](snapped(v[0].pixel), snapped(v[second].pixel), snapped(v[third].pixel));
  t.snaps = uint(snaps(v[0])) | uint(snaps(v[second])) << 1 | uint(snaps(v[third])) << 2;
  const uvec4 bins = uvec4(box) / BIN_SIZE;
  t.firstBin = bins.x | bins.y << 16;
  t.lastBin = bins.z | bins.w << 16;
  push.mesh.irregular.at[index] = t;
  atomicAdd(push.counters.c.irregularTriangles, 1u);
  addLarge(IRREGULAR | index);
  return true;
}

void main() {
  const float near = nearPlane(push.frame.c.viewProjection);
  const uvec2 size = push.frame.c.size;
  const uint quads = min(push.counters.c.irregularQuads, push.irregularCapacity);
  for (uint i = gl_GlobalInvocationID.x; i < quads; i += IRREGULAR_GROUPS * IRREGULAR_GROUP) {
    const uint number = push.mesh.irregular.at[2u * i].shading.quad;
    const PackedQuad quad = push.mesh.quads.at[number];
    const bool single = quad.corners.z == quad.corners.w;
    const bool visible0 = setUp(2u * number, 2u * i, quad, near, size);
    const bool visible1 = !single && setUp(2u * number + 1u, 2u * i + 1u, quad, near, size);
    if (!visible0 && !visible1) continue;
    atomicAdd(push.counters.c.largeQuads, 1u);
    if (push.countAll != 0u && single) atomicAdd(push.counters.c.visibleDegenerate, 1u);
  }
}
