#version 460
// Stage 2, binning of large triangles: one or more subgroups a triangle, an invocation a bin of its box, which
// is the balance between triangles of unlike sizes that the paper makes on the level of rows. COUNT 1:
// phase 1, counts; COUNT 0: phase 3, writes.
#include "raster/coverage.glsl"
#include "raster/records.glsl"

#extension GL_KHR_shader_subgroup_basic : require

layout(local_size_x = LARGE_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

void main() {
#if COUNT
  // Small and large quads share slots: nothing to count, the host makes room and records again.
  if (push.counters.c.smallQuads + push.counters.c.largeQuads > push.quadCapacity) return;
#else
  if (push.counters.c.ready == 0u) return;
#endif
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint quads = min(push.counters.c.largeQuads, push.quadCapacity);
  // Where there are fewer triangles than subgroups, several share one.
  const uint subgroups = LARGE_GROUPS * gl_NumSubgroups, sharers = max(subgroups / max(2u * quads, 1u), 1u);
  for (uint job = gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID; job < 2u * quads * sharers;
       job += subgroups) {
    const uint i = job / sharers, share = job % sharers;
    const uint quad = push.quadCapacity - 1u - i / 2u;
    const uint slot = 2u * quad + i % 2u;
    const RasterTriangle t = loadTriangle(push.triangles, slot);
    if (t.flags == 0u) continue;
    const BinBox box = push.quadBins.at[quad];
    const uvec2 first = uvec2(box.first & 0xffffu, box.first >> 16);
    const uvec2 extent = uvec2(box.last & 0xffffu, box.last >> 16) - first + 1u;
    for (uint k = share * gl_SubgroupSize + gl_SubgroupInvocationID; k < extent.x * extent.y;
         k += sharers * gl_SubgroupSize) {
      const uvec2 place = first + uvec2(k % extent.x, k / extent.x);
      const ivec2 region = ivec2(place * BIN_SIZE);
      // Trivial reject (Abrash 2009): the bin's corner that lies deepest inside is outside.
      if ((t.flags & TRIANGLE_IRREGULAR) == 0u &&
          (rejectsBin(makeEdge(t.v01.xy, t.v01.zw, region)) ||
           rejectsBin(makeEdge(t.v01.zw, t.v2, region)) ||
           rejectsBin(makeEdge(t.v2, t.v01.xy, region))))
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
