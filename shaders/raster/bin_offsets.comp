#version 460
// Stage 2, phase 2: places of the bins' lists, the bins' categories, and the parts of those that hold
// many triangles. An invocation a bin. The paper has a prefix sum over all bins; in what order the
// lists lie in memory is of no account, so that each subgroup just takes room for its bins.
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
  const uint parts = (2u * quads + triangles + PART_TRIANGLES - 1u) / PART_TRIANGLES;
  const bool low = parts == 1u;
  const uint own = quads + triangles, highParts = parts > 1u ? parts : 0u;
  // In one word each: no subgroup has 2^16 lanes.
  const uint kinds = uint(b < bins && parts == 0u) | uint(parts > 1u) << 16;
  const uint lowBefore = subgroupExclusiveAdd(uint(low)), lows = subgroupAdd(uint(low));
  const uint ownBefore = subgroupExclusiveAdd(own), all = subgroupAdd(own);
  const uint partsBefore = subgroupExclusiveAdd(highParts), allParts = subgroupAdd(highParts);
  const uint allKinds = subgroupAdd(kinds);
  uvec3 first = uvec3(0u);  // of the subgroup: in the lists, among low bins, among parts of high ones
  if (subgroupElect()) {
    if (all > 0u) first.x = atomicAdd(push.counters.c.entries, all);
    if (lows > 0u) first.y = atomicAdd(push.counters.c.lowBins, lows);
    if (allParts > 0u) first.z = atomicAdd(push.counters.c.highParts, allParts);
    if ((allKinds & 0xffffu) > 0u) atomicAdd(push.counters.c.emptyBins, allKinds & 0xffffu);
    if (allKinds >> 16 > 0u) atomicAdd(push.counters.c.highBins, allKinds >> 16);
  }
  first = subgroupBroadcastFirst(first);
  const uint list = first.x + ownBefore;
  if (own > 0u) {
    push.bins.at[b].quadOffset = list;
    push.bins.at[b].triangleOffset = list + quads;
  }
  if (low) push.parts.at[first.y + lowBefore] = Part(b, 0u, list, quads, triangles);
  // Each high bin rounds up: room for all where the entries fit.
  const uint room = 2u * (push.entryCapacity / PART_TRIANGLES + 1u) + bins;
  for (uint p = 0u; p < highParts; ++p) {
    const uint place = first.z + partsBefore + p;
    if (place < room) push.parts.at[bins + place] = Part(b, p, list, quads, triangles);
  }

  memoryBarrierBuffer();
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  const uint groups = (bins + OFFSET_GROUP - 1u) / OFFSET_GROUP;
  if (atomicAdd(push.counters.c.offsetGroupsDone, 1u) + 1u < groups) return;
  memoryBarrierBuffer();
  // The last workgroup to end knows all counts.
  const bool ready = push.counters.c.smallQuads <= push.smallCapacity &&
                     push.counters.c.largeTriangles <= push.largeCapacity &&
                     push.counters.c.irregularTriangles <= push.irregularCapacity &&
                     atomicAdd(push.counters.c.entries, 0u) <= push.entryCapacity;
  const uint smallGroups = (push.counters.c.smallQuads + SETUP_GROUP - 1u) / SETUP_GROUP;
  const uint lowBins = atomicAdd(push.counters.c.lowBins, 0u);
  const uint parts_ = atomicAdd(push.counters.c.highParts, 0u);
  push.counters.c.ready = uint(ready);
  push.counters.c.small = Dispatch(ready ? min(smallGroups, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.low = Dispatch(ready ? min(lowBins, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.high = Dispatch(ready ? min(parts_, MAX_GROUPS) : 0u, 1u, 1u);
}
