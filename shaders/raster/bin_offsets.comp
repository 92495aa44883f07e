#version 460
// Stage 2, phase 2: places of the bins' lists by a prefix sum, the bins' categories, and the parts of
// those that hold many triangles. One workgroup; each invocation takes a run of neighbouring bins.
#include "raster/raster_types.h"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

shared uint sums[1024];
shared uint emptyBins, lowBins, highBins, highParts;

void main() {
  const uint self = gl_LocalInvocationIndex, group = gl_WorkGroupSize.x;
  const uvec2 grid = (push.frame.c.size + BIN_SIZE - 1u) / BIN_SIZE;
  const uint bins = grid.x * grid.y;
  const uint run = (bins + group - 1u) / group;
  const uint begin = min(self * run, bins), end = min(begin + run, bins);
  if (self == 0u) emptyBins = lowBins = highBins = highParts = 0u;

  uint sum = 0u;
  for (uint b = begin; b < end; ++b) sum += push.bins.at[b].quads + push.bins.at[b].triangles;
  sums[self] = sum;
  barrier();
  for (uint step = 1u; step < group; step *= 2u) {  // Hillis and Steele 1986
    const uint before = self >= step ? sums[self - step] : 0u;
    barrier();
    sums[self] += before;
    barrier();
  }

  const uint entries = sums[group - 1u];
  const bool ready = push.counters.c.smallQuads + push.counters.c.largeQuads <= push.quadCapacity &&
                     push.counters.c.irregularTriangles <= push.irregularCapacity &&
                     entries <= push.entryCapacity;
  uint offset = sums[self] - sum;
  for (uint b = begin; b < end; ++b) {
    const uint quads = push.bins.at[b].quads, triangles = push.bins.at[b].triangles;
    push.bins.at[b].quadOffset = offset;
    push.bins.at[b].triangleOffset = offset + quads;
    offset += quads + triangles;
    const uint parts = (2u * quads + triangles + PART_TRIANGLES - 1u) / PART_TRIANGLES;
    if (parts == 0u) atomicAdd(emptyBins, 1u);
    else if (parts == 1u) push.parts.at[atomicAdd(lowBins, 1u)] = Part(b, 0u);
    else {
      atomicAdd(highBins, 1u);
      const uint first = bins + atomicAdd(highParts, parts);
      if (ready)
        for (uint p = 0u; p < parts; ++p) push.parts.at[first + p] = Part(b, p);
    }
  }
  barrier();
  if (self == 0u) {
    const uint smallGroups = (push.counters.c.smallQuads + SETUP_GROUP - 1u) / SETUP_GROUP;
    push.counters.c.entries = entries;
    push.counters.c.emptyBins = emptyBins;
    push.counters.c.lowBins = lowBins;
    push.counters.c.highBins = highBins;
    push.counters.c.highParts = highParts;
    push.counters.c.ready = uint(ready);
    push.counters.c.small = Dispatch(ready ? min(smallGroups, MAX_GROUPS) : 0u, 1u, 1u);
    push.counters.c.low = Dispatch(ready ? min(lowBins, MAX_GROUPS) : 0u, 1u, 1u);
    push.counters.c.high = Dispatch(ready ? min(highParts, MAX_GROUPS) : 0u, 1u, 1u);
  }
}
