#version 460
// Stage 3, phases 1 and 2 up to the sort: the list of tri-half-blocks of every half-block. One
// workgroup a bin. The paper goes from block-rows to blocks to half-blocks through scratch memory;
// here rows of pixels become half-block masks at once, first to count, then to write into lists of
// just the right size.
#include "lucid/lucid_types.h"
#include "raster/coverage.glsl"
#include "raster/records.glsl"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { LucidPush push; };

shared uint counts[HALF_BLOCKS], offsets[HALF_BLOCKS], cursors[HALF_BLOCKS];
shared uint base, total, walked;
shared uint shortLists, longLists, firstShort, firstLong;

uint slotOf(Bin bin, uint i) {
  if (i < 2u * bin.quads) return 2u * push.entries.at[bin.quadOffset + i / 2u] + i % 2u;
  return push.entries.at[bin.triangleOffset + i - 2u * bin.quads];
}

// Depth at the centroid of the covered samples (section 2, phase 2), as sortable bits.
uint sortKey(ShadeTriangle t, ivec2 corner, uint mask) {
  const vec2 sums = vec2(bitCount(mask & 0xaaaaaaaau) + 2 * bitCount(mask & 0xccccccccu) +
                             4 * bitCount(mask & 0xf0f0f0f0u),
                         bitCount(mask & 0xff00ff00u) + 2 * bitCount(mask & 0xffff0000u));
  const vec2 d = vec2(corner) + 0.5 + sums / float(bitCount(mask)) - t.anchor;
  const float invW = t.invW + t.invWSlope.x * d.x + t.invWSlope.y * d.y;
  return floatBitsToUint(max(invW, 0.0));
}

// Coverage of the four half-blocks of a strip (four rows).
uvec4 stripMasks(uvec4 rows) {
  uvec4 masks;
  [[unroll]] for (int c = 0; c < 4; ++c) {
    const uvec4 bytes = (rows >> (8 * c)) & 0xffu;
    masks[c] = bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24;
  }
  return masks;
}

void take(bool write, uint slot, ivec2 region, uint strip, uvec4 masks) {
  [[unroll]] for (uint c = 0u; c < HALF_BLOCKS_ACROSS; ++c) {
    if (masks[c] == 0u) continue;
    const uint block = strip * HALF_BLOCKS_ACROSS + c;
    if (!write) {
      atomicAdd(counts[block], 1u);
      continue;
    }
    const uint place = base + offsets[block] + atomicAdd(cursors[block], 1u);
    const ivec2 corner = region + ivec2(c * HALF_BLOCK_WIDTH, strip * HALF_BLOCK_HEIGHT);
    push.list.at[place] = uvec2(slot, masks[c]);
    push.keys.at[place] = sortKey(loadShading(push.shading, slot), corner, masks[c]);
  }
}

// All triangles of the bin, or, where there are few, all strips of all triangles.
void walk(bool write, Bin bin, ivec2 region) {
  const uint triangles = 2u * bin.quads + bin.triangles;
  const bool byStrip = triangles * STRIPS <= gl_WorkGroupSize.x;
  const uint items = byStrip ? triangles * STRIPS : triangles;
  const int rowsLeft = int(push.frame.c.size.y) - region.y, columnsLeft = int(push.frame.c.size.x) - region.x;
  const uint onScreen = bitsBetween(0, min(columnsLeft, 32) - 1);
  uint done = 0u;
  for (uint i = gl_LocalInvocationIndex; i < items; i += gl_WorkGroupSize.x) {
    ++done;
    const uint slot = slotOf(bin, byStrip ? i / STRIPS : i);
    const RasterTriangle t = loadTriangle(push.triangles, slot);
    if (t.flags == 0u) continue;
    const bool irregular = (t.flags & TRIANGLE_IRREGULAR) != 0u;
    const ivec4 box = snappedBox(t.v01.xy, t.v01.zw, t.v2);
    const int firstRow = irregular ? 0 : max(box.y - region.y, 0);
    const int lastRow = min(irregular ? 31 : box.w - region.y, min(rowsLeft, 32) - 1);
    if (firstRow > lastRow) continue;
    int strip = firstRow / 4, lastStrip = lastRow / 4;
    if (byStrip) {
      const int mine = int(i % STRIPS);
      if (mine < strip || mine > lastStrip) continue;
      strip = lastStrip = mine;
    }
    if (irregular) {
      const IrregularTriangle source = push.irregular.at[t.flags >> TRIANGLE_INDEX_SHIFT];
      const ShadeTriangle planes = loadShading(push.shading, slot);
      const float near = nearPlane(push.frame.c.viewProjection);
      for (; strip <= lastStrip; ++strip) {
        uvec4 rows;
        for (int r = 0; r < 4; ++r)
          rows[r] = 4 * strip + r > lastRow
                        ? 0u
                        : onScreen & irregularRow(t, source, planes, near, region, 4 * strip + r);
        take(write, slot, region, uint(strip), stripMasks(rows));
      }
      continue;
    }
    const RegionEdges edges = regionEdges(t, region);
    for (; strip <= lastStrip; ++strip) {
      uvec4 rows;
      [[unroll]] for (int r = 0; r < 4; ++r) {
        const int row = 4 * strip + r;
        rows[r] = row < firstRow || row > lastRow ? 0u : onScreen & rowCoverage(edges, row);
      }
      take(write, slot, region, uint(strip), stripMasks(rows));
    }
  }
  if (!write) atomicAdd(walked, done);
}

void makeLists(uint number) {
  const uint self = gl_LocalInvocationIndex;
  const Bin bin = push.bins.at[number];
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const ivec2 region = ivec2(uvec2(number % columns, number / columns) * BIN_SIZE);
  if (self < HALF_BLOCKS) counts[self] = cursors[self] = 0u;
  if (self == 0u) shortLists = longLists = walked = 0u;
  barrier();
  walk(false, bin, region);
  barrier();
  uint rank = 0u;
  if (self < HALF_BLOCKS) {
    uint before = 0u;
    for (uint b = 0u; b < self; ++b) before += counts[b];
    offsets[self] = before;
    if (self == HALF_BLOCKS - 1u) total = before + counts[self];
    if (counts[self] > 0u)
      rank = counts[self] <= LOW_LIST ? atomicAdd(shortLists, 1u) : atomicAdd(longLists, 1u);
  }
  barrier();
  if (self == 0u) {
    base = atomicAdd(push.counters.c.triHalfBlocks, total);
    firstShort = atomicAdd(push.counters.c.shortLists, shortLists);
    firstLong = atomicAdd(push.counters.c.longLists, longLists);
    const uint triangles = 2u * bin.quads + bin.triangles;
    atomicAdd(push.counters.c.walked, walked);
    atomicAdd(push.counters.c.expected,
              triangles * STRIPS <= gl_WorkGroupSize.x ? triangles * STRIPS : triangles);
  }
  barrier();
  if (base + total > push.listCapacity) return;  // counted all the same: the host makes room
  walk(true, bin, region);
  if (self < HALF_BLOCKS && counts[self] > 0u) {
    const uint rows = (push.frame.c.size.y + BIN_SIZE - 1u) / BIN_SIZE;
    const uint place = counts[self] <= LOW_LIST
                           ? firstShort + rank
                           : columns * rows * HALF_BLOCKS - 1u - (firstLong + rank);
    push.blocks.at[place] =
        HalfBlock(number * HALF_BLOCKS + self, base + offsets[self], counts[self]);
  }
}

// As many workgroups, in rows that every device can dispatch.
Dispatch dispatchOf(uint groups) {
  return Dispatch(min(groups, MAX_GROUPS), (groups + MAX_GROUPS - 1u) / MAX_GROUPS, 1u);
}

void main() {
  // HIGH 1: bins of many triangles, by large workgroups; HIGH 0: the others.
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint rows = (push.frame.c.size.y + BIN_SIZE - 1u) / BIN_SIZE;
#if HIGH
  const uint bins = push.rasterCounters.c.highBins;
#else
  const uint bins = push.rasterCounters.c.lowBins;
#endif
  for (uint i = gl_WorkGroupID.x; i < bins; i += gl_NumWorkGroups.x) {
    makeLists(push.binLists.at[HIGH == 1 ? columns * rows - 1u - i : i]);
    barrier();  // the shared counts are used anew
  }
  if (gl_LocalInvocationIndex != 0u) return;
  memoryBarrierBuffer();
  const uint groups = push.rasterCounters.c.low.x + push.rasterCounters.c.high.x;
  if (atomicAdd(push.counters.c.groupsDone, 1u) + 1u < groups) return;
  // The last workgroup to end, of either kind, knows all counts.
  const bool ready = atomicAdd(push.counters.c.triHalfBlocks, 0u) <= push.listCapacity;
  const uint lowGroups = (atomicAdd(push.counters.c.shortLists, 0u) + LOW_TEAMS - 1u) / LOW_TEAMS;
  const uint highGroups = atomicAdd(push.counters.c.longLists, 0u);
  push.counters.c.low = dispatchOf(ready ? lowGroups : 0u);
  push.counters.c.high = dispatchOf(ready ? highGroups : 0u);
  push.counters.c.repair = Dispatch(0u, 1u, 1u);
  push.counters.c.deep = Dispatch(0u, 1u, 1u);
  push.counters.c.deepResolve = Dispatch(0u, 1u, 1u);
}
