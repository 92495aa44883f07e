#version 460
// Stage 2, phase 3 for small quads: writes each quad to the lists of the bins that its bounding box overlaps. Up to 3
// of 4 may be overlapped only by the box. Rasterization then finds no coverage.
#include "raster/raster_types.h"
#include "raster/binning/subgroup_aggregate.glsl"

layout(local_size_x = SETUP_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

void main() {
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint quads = push.counters.c.smallQuads, stride = push.counters.c.small.x * SETUP_GROUP;
  for (uint i = gl_GlobalInvocationID.x; subgroupAny(i < quads); i += stride) {
    uvec2 item = uvec2(0u);
    if (i < quads) item = push.smallQuads.at[i];
    uvec2 first, extent;
    unpackBins(item.y, first, extent);
    for (uint k = 0u; k < SMALL_QUAD_BINS; ++k) {
      const bool valid = k < extent.x * extent.y;
      if (!subgroupAny(valid)) break;
      const uint bin = (first.y + k / max(extent.x, 1u)) * columns + first.x + k % max(extent.x, 1u);
      const Aggregate t = aggregate(bin, valid);
      uint place = 0u;
      if (t.count > 0u)
        place = push.bins.at[bin].quadOffset + atomicAdd(push.bins.at[bin].quadCursor, t.count);
      place = subgroupShuffle(place, t.leader) + t.rank;
      if (valid) push.entries.at[place] = item.x;
    }
  }
}
