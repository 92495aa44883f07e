#version 460
// Stage 2, binning of large triangles: one or more subgroups per triangle, one invocation per bin of its bounding box.
// This balances triangles of different sizes, which the paper does per row. COUNT 1: phase 1, counts. COUNT 0:
// phase 3, writes.
#include "raster/coverage.glsl"

#extension GL_KHR_shader_subgroup_basic : require

layout(local_size_x = LARGE_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

void main() {
#if COUNT == 0
  if (push.counters.c.ready == 0u) return;
#endif
  const uvec2 size = push.frame.c.size;
  const uint columns = (size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint triangles = min(push.counters.c.largeTriangles, push.largeCapacity);
  // If there are fewer triangles than subgroups, several subgroups share a triangle.
  const uint subgroups = push.largeGroups * gl_NumSubgroups, sharers = max(subgroups / max(triangles, 1u), 1u);
  for (uint job = gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID; job < triangles * sharers;
       job += subgroups) {
    const uint slot = push.large.at[job / sharers], share = job % sharers;
    const bool isSnapped = !isUnsnapped(slot);
    RasterTriangle t;
    uvec2 first, extent;
    if (isSnapped) {
      t = positive(loadTriangle(push.mesh, slot));
      const uvec4 bins = uvec4(clampBox(snappedBox(t.v[0], t.v[1], t.v[2]), size)) / BIN_SIZE;
      first = bins.xy;
      extent = bins.zw - first + 1u;
    } else {
      const uint from = push.mesh.unsnapped.at[slot & ~UNSNAPPED].firstBin;
      const uint to = push.mesh.unsnapped.at[slot & ~UNSNAPPED].lastBin;
      first = uvec2(from & 0xffffu, from >> 16);
      extent = uvec2(to & 0xffffu, to >> 16) - first + 1u;
    }
    for (uint k = share * gl_SubgroupSize + gl_SubgroupInvocationID; k < extent.x * extent.y;
         k += sharers * gl_SubgroupSize) {
      const uvec2 place = first + uvec2(k % extent.x, k / extent.x);
      const ivec2 region = ivec2(place * BIN_SIZE);
      // Trivial reject (Abrash 2009): the bin's corner that lies deepest inside is outside.
      if (isSnapped && (rejectsBin(makeEdge(t.v[0], t.v[1], region)) ||
                      rejectsBin(makeEdge(t.v[1], t.v[2], region)) ||
                      rejectsBin(makeEdge(t.v[2], t.v[0], region))))
        continue;
      const uint bin = place.y * columns + place.x;
#if COUNT
      atomicAdd(push.bins.at[bin].triangles, 1u);
#else
      const uint cursor = atomicAdd(push.bins.at[bin].triangleCursor, 1u);
      push.entries.at[push.bins.at[bin].triangleOffset + cursor] = slot;
#endif
    }
  }
}
