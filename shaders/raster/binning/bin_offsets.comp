#version 460
// Stage 2, phase 2: allocates the lists of the bins, classifies the bins, and divides bins with many triangles into
// segments. One invocation per bin. The paper computes a prefix sum over all bins. The order of the lists in memory
// does not matter, so here each subgroup allocates the lists of its bins.
#include "raster/raster_types.h"

#extension GL_KHR_shader_subgroup_arithmetic : require

layout(local_size_x = OFFSET_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

void main() {
  const uvec2 grid = (push.frame.c.size + BIN_SIZE - 1u) / BIN_SIZE;
  const uint bins = grid.x * grid.y, b = gl_GlobalInvocationID.x;
  uint quads = 0u, triangles = 0u;
  if (b < bins) {
    quads = push.bins.at[b].quads;
    triangles = push.bins.at[b].triangles;
  }
  const uint segments = (2u * quads + triangles + SEGMENT_TRIANGLES - 1u) / SEGMENT_TRIANGLES;
  const bool low = segments == 1u;
  const uint own = quads + triangles, highSegments = segments > 1u ? segments : 0u;
  // Two counts in one word: no subgroup has 2^16 lanes.
  const uint kinds = uint(b < bins && segments == 0u) | uint(segments > 1u) << 16;
  const uint lowBefore = subgroupExclusiveAdd(uint(low)), lows = subgroupAdd(uint(low));
  const uint ownBefore = subgroupExclusiveAdd(own), all = subgroupAdd(own);
  const uint segmentsBefore = subgroupExclusiveAdd(highSegments), allSegments = subgroupAdd(highSegments);
  const uint allKinds = subgroupAdd(kinds);
  uvec3 first = uvec3(0u);  // first place of the subgroup in the lists, among low bins, among segments of high bins
  if (subgroupElect()) {
    if (all > 0u) first.x = atomicAdd(push.counters.c.entries, all);
    if (lows > 0u) first.y = atomicAdd(push.counters.c.lowBins, lows);
    if (allSegments > 0u) first.z = atomicAdd(push.counters.c.highSegments, allSegments);
    if ((allKinds & 0xffffu) > 0u) atomicAdd(push.counters.c.emptyBins, allKinds & 0xffffu);
    if (allKinds >> 16 > 0u) atomicAdd(push.counters.c.highBins, allKinds >> 16);
  }
  first = subgroupBroadcastFirst(first);
  const uint list = first.x + ownBefore;
  if (own > 0u) {
    push.bins.at[b].quadOffset = list;
    push.bins.at[b].triangleOffset = list + quads;
  }
  if (low) push.segments.at[first.y + lowBefore] = Segment(b, 0u, list, quads, triangles);
  // Each high bin rounds up. All segments fit if the entries do.
  const uint room = 2u * (push.entryCapacity / SEGMENT_TRIANGLES + 1u) + bins;
  for (uint p = 0u; p < highSegments; ++p) {
    const uint place = first.z + segmentsBefore + p;
    if (place < room) push.segments.at[bins + place] = Segment(b, p, list, quads, triangles);
  }

  memoryBarrierBuffer();
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  const uint groups = (bins + OFFSET_GROUP - 1u) / OFFSET_GROUP;
  if (atomicAdd(push.counters.c.offsetGroupsDone, 1u) + 1u < groups) return;
  memoryBarrierBuffer();
  // The last workgroup to finish knows all counts.
  const bool ready = push.counters.c.smallQuads <= push.smallCapacity &&
                     push.counters.c.largeTriangles <= push.largeCapacity &&
                     push.counters.c.unsnappedTriangles <= push.unsnappedCapacity &&
                     atomicAdd(push.counters.c.entries, 0u) <= push.entryCapacity;
  const uint smallGroups = (push.counters.c.smallQuads + SETUP_GROUP - 1u) / SETUP_GROUP;
  const uint lowBins = atomicAdd(push.counters.c.lowBins, 0u);
  const uint segments_ = atomicAdd(push.counters.c.highSegments, 0u);
  push.counters.c.ready = uint(ready);
  push.counters.c.small = Dispatch(ready ? min(smallGroups, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.low = Dispatch(ready ? min(lowBins, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.high = Dispatch(ready ? min(segments_, MAX_GROUPS) : 0u, 1u, 1u);
}
