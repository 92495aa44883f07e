#version 460
// Stage 3, phases 1 and 2 up to the sort: the list of tri-half-blocks of every half-block. A workgroup
// a part of a bin. The paper goes from block-rows to blocks to half-blocks through scratch memory; here
// rows of pixels become half-block masks at once, in shared memory, and go into lists of just the right
// size.
//
// PASS 0: bins of one part: counts and writes. PASS 1: counts bins of several parts, the last of which
// makes room for all. PASS 2: writes these.
#include "lucid/lucid_types.h"
#include "lucid/sort_key.glsl"
#include "raster/coverage.glsl"
#include "raster/records.glsl"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { BlocksPush push; };

// What of a part fits is kept from counting to writing; what does not is rasterized again. Few parts
// of the paper's scenes have more than 700.
#define KEPT 1024u
shared uvec2 keptItems[KEPT];  // slot, mask
shared uint keptPlaces[KEPT];  // half-block, and above its HALF_BLOCK_BITS the place in its list
#define HALF_BLOCK_BITS 5

shared uint counts[HALF_BLOCKS], starts[HALF_BLOCKS], cursors[HALF_BLOCKS], lengths[HALF_BLOCKS];
shared uint kept, base, total;
shared uint shortLists, lowLists, highLists, firstShort, firstLow, firstHigh;
shared uint last;

struct Span {
  Bin bin;
  ivec2 region;      // the bin's first pixel
  uint first, count; // triangles of the bin's list
};

uint slotOf(Bin bin, uint i) {
  if (i < 2u * bin.quads) return 2u * push.entries.at[bin.quadOffset + i / 2u] + i % 2u;
  return push.entries.at[bin.triangleOffset + i - 2u * bin.quads];
}

ivec2 cornerIn(ivec2 region, uint block) {
  return region + ivec2(block % HALF_BLOCKS_ACROSS * HALF_BLOCK_WIDTH,
                        block / HALF_BLOCKS_ACROSS * HALF_BLOCK_HEIGHT);
}

void writeItem(ivec2 region, uint slot, uint mask, uint block, uint place) {
  push.list.at[starts[block] + place] = uvec2(slot, mask);
  if (lengths[block] > SHORT_LIST)
    push.keys.at[starts[block] + place] =
        sortKey(loadShading(push.shading, slot), cornerIn(region, block), mask);
}

void take(bool write, Span span, uint slot, uint block, uint mask) {
  if (mask == 0u) return;
  if (write) {
    writeItem(span.region, slot, mask, block, atomicAdd(cursors[block], 1u));
    return;
  }
  const uint place = atomicAdd(counts[block], 1u);
#if PASS != 1
  const uint k = atomicAdd(kept, 1u);
  if (k >= KEPT) return;
  keptItems[k] = uvec2(slot, mask);
  keptPlaces[k] = block | place << HALF_BLOCK_BITS;
#endif
}

void takeStrip(bool write, Span span, uint slot, int strip, uvec4 masks) {
  [[unroll]] for (uint c = 0u; c < HALF_BLOCKS_ACROSS; ++c)
    take(write, span, slot, uint(strip) * HALF_BLOCKS_ACROSS + c, masks[c]);
}

// Coverage of a strip's half-blocks by rows [first, last] of the bin.
uvec4 coverStrip(RegionEdges edges, int strip, int first, int lastRow, uint onScreen) {
  uvec4 masks = uvec4(0u);
  for (int row = max(first, 4 * strip); row <= min(lastRow, 4 * strip + 3); ++row) {
    const uint covered = onScreen & rowCoverage(edges, row);
    masks |= (uvec4(covered, covered >> 8, covered >> 16, covered >> 24) & 0xffu) << (8 * (row & 3));
  }
  return masks;
}

uvec4 coverIrregularStrip(RasterTriangle t, IrregularTriangle source, ShadeTriangle planes, float near,
                          ivec2 region, int strip, int lastRow, uint onScreen) {
  uvec4 masks = uvec4(0u);
  for (int row = 4 * strip; row <= min(lastRow, 4 * strip + 3); ++row) {
    const uint covered = onScreen & irregularRow(t, source, planes, near, region, row);
    masks |= (uvec4(covered, covered >> 8, covered >> 16, covered >> 24) & 0xffu) << (8 * (row & 3));
  }
  return masks;
}

// All triangles of the span, or, where there are few, all strips of all triangles.
void walk(bool write, Span span) {
  const bool byStrip = false;
  const uint items = byStrip ? span.count * STRIPS : span.count;
  const int rows = min(int(push.size.y) - span.region.y, 32);
  const uint onScreen = bitsBetween(0, min(int(push.size.x) - span.region.x, 32) - 1);
  for (uint i = gl_LocalInvocationIndex; i < items; i += gl_WorkGroupSize.x) {
    const uint slot = slotOf(span.bin, span.first + (byStrip ? i / STRIPS : i));
    const RasterTriangle t = loadTriangle(push.triangles, slot);
    if (t.flags == 0u) continue;
    const bool irregular = (t.flags & TRIANGLE_IRREGULAR) != 0u;
    const ivec4 box = snappedBox(t.v01.xy, t.v01.zw, t.v2);
    const int firstRow = irregular ? 0 : max(box.y - span.region.y, 0);
    const int lastRow = min(irregular ? 31 : box.w - span.region.y, rows - 1);
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
      for (; strip <= lastStrip; ++strip)
        takeStrip(write, span, slot, strip,
                  coverIrregularStrip(t, source, planes, near, span.region, strip, lastRow, onScreen));
      continue;
    }
    const RegionEdges edges = regionEdges(t, span.region);
    for (; strip <= lastStrip; ++strip)
      takeStrip(write, span, slot, strip, coverStrip(edges, strip, firstRow, lastRow, onScreen));
  }
}

void writeAll(Span span) {
  const uint self = gl_LocalInvocationIndex;
  if (kept > KEPT) {
    walk(true, span);
    return;
  }
  for (uint k = self; k < kept; k += gl_WorkGroupSize.x) {
    const uint place = keptPlaces[k];
    writeItem(span.region, keptItems[k].x, keptItems[k].y, place & (HALF_BLOCKS - 1u),
              place >> HALF_BLOCK_BITS);
  }
}

// Makes room for the lists of a bin, of these lengths: `starts`. All invocations take part.
void makeLists(uint number) {
  const uint self = gl_LocalInvocationIndex;
  if (self == 0u) shortLists = lowLists = highLists = 0u;
  barrier();
  uint rank = 0u, before = 0u;
  if (self < HALF_BLOCKS) {
    for (uint b = 0u; b < self; ++b) before += lengths[b];
    const uint length = lengths[self];
    if (self == HALF_BLOCKS - 1u) total = before + length;
    if (length > LOW_LIST) rank = atomicAdd(highLists, 1u);
    else if (length > SHORT_LIST) rank = atomicAdd(lowLists, 1u);
    else if (length > 0u) rank = atomicAdd(shortLists, 1u);
  }
  barrier();
  if (self == 0u) {
    if (total > 0u) base = atomicAdd(push.counters.c.triHalfBlocks, total);
    if (shortLists > 0u) firstShort = atomicAdd(push.counters.c.shortLists, shortLists);
    if (lowLists > 0u) firstLow = atomicAdd(push.counters.c.lowLists, lowLists);
    if (highLists > 0u) firstHigh = atomicAdd(push.counters.c.highLists, highLists);
  }
  barrier();
  if (self < HALF_BLOCKS) {
    const uint length = lengths[self];
    starts[self] = base + before;
    const uint place = length > LOW_LIST     ? push.halfBlocks - 1u - (firstHigh + rank)
                       : length > SHORT_LIST ? push.halfBlocks + firstLow + rank
                                             : firstShort + rank;
    if (length > 0u)
      push.blocks.at[place] = HalfBlock(number * HALF_BLOCKS + self, base + before, length);
  }
  barrier();
}

// `place`: of the part among those of high bins.
void goThrough(Part part, uint place) {
  const uint self = gl_LocalInvocationIndex;
  const uvec2 grid = (push.size + BIN_SIZE - 1u) / BIN_SIZE;
  Span span;
  span.bin = push.bins.at[part.bin];
  span.region = ivec2(uvec2(part.bin % grid.x, part.bin / grid.x) * BIN_SIZE);
  span.first = part.number * PART_TRIANGLES;
  span.count = min(2u * span.bin.quads + span.bin.triangles - span.first, PART_TRIANGLES);
  if (self < HALF_BLOCKS) counts[self] = cursors[self] = 0u;
  if (self == 0u) kept = 0u;
  barrier();
  walk(false, span);
  barrier();

  const uint own = part.bin * HALF_BLOCKS + self, ownInPart = place * HALF_BLOCKS + self;
#if PASS == 0
  if (self < HALF_BLOCKS) lengths[self] = counts[self];
  makeLists(part.bin);
  if (base + total <= push.listCapacity) writeAll(span);  // counted all the same: the host makes room
#elif PASS == 1
  if (self < HALF_BLOCKS)
    push.partFirsts.at[ownInPart] = atomicAdd(push.binBlocks.at[own].count, counts[self]);
  memoryBarrierBuffer();
  barrier();
  const uint parts = (2u * span.bin.quads + span.bin.triangles + PART_TRIANGLES - 1u) / PART_TRIANGLES;
  if (self == 0u)
    last = uint(atomicAdd(push.binBlocks.at[part.bin * HALF_BLOCKS].partsDone, 1u) + 1u == parts);
  barrier();
  // The others make room for nothing: barriers stay out of branches.
  if (self < HALF_BLOCKS)
    lengths[self] = last != 0u ? atomicAdd(push.binBlocks.at[own].count, 0u) : 0u;
  makeLists(part.bin);
  if (last != 0u && self < HALF_BLOCKS) push.binBlocks.at[own].first = starts[self];
#else
  if (self < HALF_BLOCKS) {
    lengths[self] = push.binBlocks.at[own].count;
    starts[self] = push.binBlocks.at[own].first + push.partFirsts.at[ownInPart];
  }
  barrier();
  writeAll(span);
#endif
}

// As many workgroups, in rows that every device can dispatch.
Dispatch dispatchOf(uint groups) {
  return Dispatch(min(groups, MAX_GROUPS), (groups + MAX_GROUPS - 1u) / MAX_GROUPS, 1u);
}

void main() {
#if PASS == 0
  const uint parts = push.rasterCounters.c.lowBins, firstPart = 0u;
#else
  const uint parts = push.rasterCounters.c.highParts, firstPart = push.halfBlocks / HALF_BLOCKS;
#endif
#if PASS == 2
  if (push.counters.c.triHalfBlocks > push.listCapacity) return;
#endif
  for (uint i = gl_WorkGroupID.x; i < parts; i += gl_NumWorkGroups.x) {
    goThrough(push.parts.at[firstPart + i], i);
    barrier();  // the shared counts are used anew
  }
#if PASS < 2
  if (gl_LocalInvocationIndex != 0u) return;
  memoryBarrierBuffer();
  const uint groups = push.rasterCounters.c.low.x + push.rasterCounters.c.high.x;
  if (atomicAdd(push.counters.c.groupsDone, 1u) + 1u < groups) return;
  // The last workgroup to end, of either kind, knows all counts.
  const bool ready = atomicAdd(push.counters.c.triHalfBlocks, 0u) <= push.listCapacity;
  const uint short_ = (atomicAdd(push.counters.c.shortLists, 0u) + LOW_TEAMS - 1u) / LOW_TEAMS;
  const uint low = (atomicAdd(push.counters.c.lowLists, 0u) + LOW_TEAMS - 1u) / LOW_TEAMS;
  const uint high = atomicAdd(push.counters.c.highLists, 0u);
  push.counters.c.ordered = dispatchOf(ready ? short_ : 0u);
  push.counters.c.low = Dispatch(ready ? min(low, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.high = Dispatch(ready ? min(high, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.repair = Dispatch(0u, 1u, 1u);
  push.counters.c.deep = Dispatch(0u, 1u, 1u);
  push.counters.c.deepResolve = Dispatch(0u, 1u, 1u);
#endif
}
