#version 460
// Stage 2, phase 3 for small quads: writes each to the lists of the bins that its box overlaps. Up to
// 3 of 4 may be overlapped by the box alone; rasterization finds these empty.
#include "raster/raster_types.h"

layout(local_size_x = SETUP_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

void main() {
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint stride = push.counters.c.small.x * SETUP_GROUP;
  for (uint quad = gl_GlobalInvocationID.x; quad < push.counters.c.smallQuads; quad += stride) {
    const BinBox box = push.quadBins.at[quad];
    for (uint y = box.first >> 16; y <= box.last >> 16; ++y)
      for (uint x = box.first & 0xffffu; x <= (box.last & 0xffffu); ++x) {
        const uint bin = y * columns + x;
        const uint cursor = atomicAdd(push.bins.at[bin].quadCursor, 1u);
        push.entries.at[push.bins.at[bin].quadOffset + cursor] = quad;
      }
  }
}
