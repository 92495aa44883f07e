#version 460
// Stage 3, phases 1 and 2 up to the sort: the list of tri-half-blocks of every half-block. A workgroup
// a part of a bin. The paper goes from block-rows to blocks to half-blocks through scratch memory; here
// rows of pixels become half-block masks at once, in shared memory, and go into lists of just the right
// size.
//
// FIRST_LIST: ORDERED_LIST, or 0 where all lists go through the depth filter.
//
// PASS 0: bins of one part: counts and writes. PASS 1: counts bins of several parts, the last of which
// makes room for all. PASS 2: writes these.
#include "lucid/lucid_types.h"
#include "lucid/sort_key.glsl"
#include "raster/coverage.glsl"
#include "raster/records.glsl"

layout(local_size_x = GROUP) in;
layout(push_constant, scalar) uniform Push { BlocksPush push; };

// What of a part fits is kept from counting to writing; what does not is rasterized again. Few parts
// of the paper's scenes have more than 700.
#define KEPT 1024u
shared uint keptMasks[KEPT];
shared uint keptPlaces[KEPT];  // half-block, triangle of the part, place in the half-block's list
#define TRIANGLE_SHIFT 5  // above the half-block: PART_TRIANGLES
#define PLACE_SHIFT 13

shared uint counts[HALF_BLOCKS], starts[HALF_BLOCKS], cursors[HALF_BLOCKS], lengths[HALF_BLOCKS];
shared uint kept, base, total;
shared uint orderedLists, lowLists, highLists, firstOrdered, firstLow, firstHigh;
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
  push.keys.at[starts[block] + place] =
      sortKey(loadShading(push.shading, slot), cornerIn(region, block), mask);
}

// `number`: of the triangle in its part.
void takeStrip(bool write, Span span, uint slot, uint number, int strip, uvec4 masks) {
#if PASS != 1
  uint k = 0u;
  if (!write) k = atomicAdd(kept, uint(dot(vec4(notEqual(masks, uvec4(0u))), vec4(1.0))));
#endif
  [[unroll]] for (uint c = 0u; c < HALF_BLOCKS_ACROSS; ++c) {
    if (masks[c] == 0u) continue;
    const uint block = uint(strip) * HALF_BLOCKS_ACROSS + c;
    if (write) {
      writeItem(span.region, slot, masks[c], block, atomicAdd(cursors[block], 1u));
      continue;
    }
    const uint place = atomicAdd(counts[block], 1u);
#if PASS != 1
    if (k < KEPT) {
      keptMasks[k] = masks[c];
      keptPlaces[k] = block | number << TRIANGLE_SHIFT | place << PLACE_SHIFT;
    }
    ++k;
#endif
  }
}

// A row's part of the masks of its strip's half-blocks.
uvec4 masksOfRow(uint covered, int row) {
  return (uvec4(covered, covered >> 8, covered >> 16, covered >> 24) & 0xffu) << (8 * (row & 3));
}

// Coverage of a strip's half-blocks by rows [first, last_] of the bin.
uvec4 coverStrip(RegionEdges edges, int strip, int first, int last_, uint onScreen) {
  uvec4 masks = uvec4(0u);
  for (int row = max(first, 4 * strip); row <= min(last_, 4 * strip + 3); ++row) {
    masks |= masksOfRow(onScreen & rowCoverage(edges, row), row);
  }
  return masks;
}

uvec4 coverIrregularStrip(uint slot, uint flags, ivec2 region, int strip, int last_, uint onScreen) {
  uvec4 masks = uvec4(0u);
  for (int row = 4 * strip; row <= min(last_, 4 * strip + 3); ++row) {
    const uint covered = onScreen & irregularRow(push.triangles, push.irregular, push.shading, slot,
                                                 flags, push.near, region, row);
    masks |= masksOfRow(covered, row);
  }
  return masks;
}

// All triangles of the span, or, where there are few, all strips of all triangles.
void walk(bool write, Span span) {
  const bool byStrip = span.count * STRIPS <= 2u * GROUP;
  const uint items = byStrip ? span.count * STRIPS : span.count;
  const int rows = min(int(push.size.y) - span.region.y, 32);
  const uint onScreen = bitsBetween(0, min(int(push.size.x) - span.region.x, 32) - 1);
  for (uint i = gl_LocalInvocationIndex; i < items; i += GROUP) {
    const uint number = byStrip ? i / STRIPS : i, slot = slotOf(span.bin, span.first + number);
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
      for (; strip <= lastStrip; ++strip)
        takeStrip(write, span, slot, number, strip,
                  coverIrregularStrip(slot, t.flags, span.region, strip, lastRow, onScreen));
      continue;
    }
    const RegionEdges edges = regionEdges(t, span.region);
    for (; strip <= lastStrip; ++strip)
      takeStrip(write, span, slot, number, strip, coverStrip(edges, strip, firstRow, lastRow, onScreen));
  }
}

void writeKept(Span span) {
  for (uint k = gl_LocalInvocationIndex; k < kept; k += GROUP) {
    const uint place = keptPlaces[k];
    const uint number = bitfieldExtract(place, TRIANGLE_SHIFT, PLACE_SHIFT - TRIANGLE_SHIFT);
    writeItem(span.region, slotOf(span.bin, span.first + number), keptMasks[k],
              place & (HALF_BLOCKS - 1u), place >> PLACE_SHIFT);
  }
}

uint halfBlocksOfFrame() {
  const uvec2 grid = (push.size + BIN_SIZE - 1u) / BIN_SIZE;
  return grid.x * grid.y * HALF_BLOCKS;
}

// Makes room for the lists of a bin, of these lengths: `starts`. All invocations take part.
void makeLists(uint number) {
  const uint self = gl_LocalInvocationIndex;
  if (self == 0u) orderedLists = lowLists = highLists = 0u;
  barrier();
  uint rank = 0u, before = 0u;
  if (self < HALF_BLOCKS) {
    [[unroll]] for (uint b = 0u; b < HALF_BLOCKS; ++b) before += b < self ? lengths[b] : 0u;
    const uint length = lengths[self];
    if (self == HALF_BLOCKS - 1u) total = before + length;
    if (length > LOW_LIST) rank = atomicAdd(highLists, 1u);
    else if (length > FIRST_LIST) rank = atomicAdd(lowLists, 1u);
    else if (length > 0u) rank = atomicAdd(orderedLists, 1u);
  }
  barrier();
  if (self == 0u) {
    base = total > 0u ? atomicAdd(push.counters.c.triHalfBlocks, total) : 0u;
    if (orderedLists > 0u) firstOrdered = atomicAdd(push.counters.c.orderedLists, orderedLists);
    if (lowLists > 0u) firstLow = atomicAdd(push.counters.c.filterJobs, lowLists);
    if (highLists > 0u) firstHigh = atomicAdd(push.counters.c.highLists, highLists);
  }
  barrier();
  if (self < HALF_BLOCKS) {
    const uint length = lengths[self];
    starts[self] = base + before;
    const HalfBlock block = HalfBlock(number * HALF_BLOCKS + self, base + before, length);
    if (length > LOW_LIST)
      push.blocks.at[halfBlocksOfFrame() - 1u - (firstHigh + rank)] = block;
    else if (length > FIRST_LIST)
      push.filterJobs.at[firstLow + rank] = PixelJob(block, 0xffffffffu);
    else if (length > 0u)
      push.blocks.at[firstOrdered + rank] = block;
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
  span.first = part.number * PART_TRIANGLES;  // at most 2^(PLACE_SHIFT - TRIANGLE_SHIFT)
  span.count = min(2u * span.bin.quads + span.bin.triangles - span.first, PART_TRIANGLES);
  if (self < HALF_BLOCKS) counts[self] = cursors[self] = 0u;
  if (self == 0u) kept = 0u;
  barrier();
  const uint own = part.bin * HALF_BLOCKS + self, ownInPart = place * HALF_BLOCKS + self;
#if PASS == 1
  walk(false, span);
  barrier();
  if (self < HALF_BLOCKS)
    push.partFirsts.at[ownInPart] = atomicAdd(push.binBlocks.at[own].count, counts[self]);
  memoryBarrierBuffer();
  barrier();
  memoryBarrierBuffer();  // of what the others released, by the one invocation that says so
  const uint parts = (2u * span.bin.quads + span.bin.triangles + PART_TRIANGLES - 1u) / PART_TRIANGLES;
  if (self == 0u)
    last = uint(atomicAdd(push.binBlocks.at[part.bin * HALF_BLOCKS].partsDone, 1u) + 1u == parts);
  memoryBarrierBuffer();
  barrier();
  memoryBarrierBuffer();
  // The others make room for nothing: barriers stay out of branches.
  if (self < HALF_BLOCKS)
    lengths[self] = last != 0u ? atomicAdd(push.binBlocks.at[own].count, 0u) : 0u;
  makeLists(part.bin);
  if (last != 0u && self < HALF_BLOCKS) push.binBlocks.at[own].first = starts[self];
#else
  // Counts, then writes what was kept, or what it rasterizes again: one loop, so that the code for both
  // is there once.
  for (uint phase = 0u; phase < 2u; ++phase) {
    if (phase == 0u || kept > KEPT) walk(phase == 1u, span);
    else writeKept(span);
    barrier();
    if (phase == 1u) break;
#if PASS == 0
    if (self < HALF_BLOCKS) lengths[self] = counts[self];
    makeLists(part.bin);
    if (base + total > push.listCapacity) break;  // counted all the same: the host makes room
#else
    if (self < HALF_BLOCKS)
      starts[self] = push.binBlocks.at[own].first + push.partFirsts.at[ownInPart];
    barrier();
#endif
  }
#endif
}

// As many workgroups, in rows that every device can dispatch.
Dispatch dispatchOf(uint groups) {
  return Dispatch(min(groups, MAX_GROUPS), (groups + MAX_GROUPS - 1u) / MAX_GROUPS, 1u);
}

void main() {
#if PASS == 0
  const uint parts = push.rasterCounters.c.lowBins, firstPart = 0u, groupCount = push.rasterCounters.c.low.x;
#else
  const uint parts = push.rasterCounters.c.highParts, firstPart = halfBlocksOfFrame() / HALF_BLOCKS;
  const uint groupCount = push.rasterCounters.c.high.x;
#endif
#if PASS == 2
  if (push.counters.c.triHalfBlocks > push.listCapacity) return;
#endif
  for (uint i = gl_WorkGroupID.x; i < parts; i += groupCount) {
    goThrough(push.parts.at[firstPart + i], i);
    barrier();  // the shared counts are used anew
  }
#if PASS < 2
  if (gl_LocalInvocationIndex != 0u) return;
  memoryBarrierBuffer();
  const uint groups = push.rasterCounters.c.low.x + push.rasterCounters.c.high.x;
  if (atomicAdd(push.counters.c.groupsDone, 1u) + 1u < groups) return;
  memoryBarrierBuffer();
  // The last workgroup to end, of either kind, knows all counts.
  const bool ready = atomicAdd(push.counters.c.triHalfBlocks, 0u) <= push.listCapacity;
  const uint ordered = (atomicAdd(push.counters.c.orderedLists, 0u) + LOW_TEAMS - 1u) / LOW_TEAMS;
  const uint low = (atomicAdd(push.counters.c.filterJobs, 0u) + LOW_TEAMS - 1u) / LOW_TEAMS;
  const uint high = atomicAdd(push.counters.c.highLists, 0u);
  push.counters.c.ordered = dispatchOf(ready ? ordered : 0u);
  push.counters.c.low = Dispatch(ready ? min(low, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.high = Dispatch(ready ? min(high, MAX_GROUPS) : 0u, 1u, 1u);
  push.counters.c.repair = Dispatch(0u, 1u, 1u);
  push.counters.c.deep = Dispatch(0u, 1u, 1u);
  push.counters.c.deepResolve = Dispatch(0u, 1u, 1u);
#endif
}
