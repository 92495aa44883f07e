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

layout(local_size_x = GROUP) in;
layout(push_constant, scalar) uniform Push { BlocksPush push; };

// What of a part fits is kept from counting to writing; what does not is rasterized again. Few parts
// of the paper's scenes have more than 700.
#define KEPT 1024u
shared uvec2 keptItems[KEPT];  // slot, mask
shared uint keptPlaces[KEPT];  // half-block, and above its HALF_BLOCK_BITS the place in its list
#define HALF_BLOCK_BITS 5

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

void takeStrip(bool write, Span span, uint slot, int strip, uvec4 masks) {
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
      keptItems[k] = uvec2(slot, masks[c]);
      keptPlaces[k] = block | place << HALF_BLOCK_BITS;
    }
    ++k;
#endif
  }
}

// Triangles at work, and the strips that they reach: triangles are of unlike height, and lanes that
// each kept to one would wait for the tallest.
shared uvec4 edgeWords[4u * GROUP];  // see storeEdges
shared uint stripItems[STRIPS * GROUP];  // place of the triangle, strip << 16
shared uint items;

struct Rows {
  uint slot;
  int first, last;  // of the bin
  bool irregular;
};

void storeEdges(uint at, Rows rows, RegionEdges r) {
  edgeWords[4u * at] = uvec4(rows.slot, uint(rows.first | rows.last << 8 | (rows.irregular ? 1 << 16 : 0)),
                             floatBitsToUint(r.inverseA.xy));
  edgeWords[4u * at + 1u] = uvec4(r.edge[0].c, r.edge[0].a, r.edge[0].b, floatBitsToUint(r.inverseA.z));
  edgeWords[4u * at + 2u] = uvec4(r.edge[1].c, r.edge[1].a, r.edge[1].b, r.edge[2].c);
  edgeWords[4u * at + 3u] = uvec4(r.edge[2].a, r.edge[2].b, 0u, 0u);
}

RegionEdges loadEdges(uint at, out Rows rows) {
  const uvec4 w0 = edgeWords[4u * at];
  const ivec4 w1 = ivec4(edgeWords[4u * at + 1u]), w2 = ivec4(edgeWords[4u * at + 2u]);
  const ivec4 w3 = ivec4(edgeWords[4u * at + 3u]);
  rows = Rows(w0.x, int(w0.y & 0xffu), int((w0.y >> 8) & 0xffu), (w0.y >> 16) != 0u);
  RegionEdges r;
  r.edge[0] = Edge(w1.x, w1.y, w1.z);
  r.edge[1] = Edge(w2.x, w2.y, w2.z);
  r.edge[2] = Edge(w2.w, w3.x, w3.y);
  r.inverseA = vec3(uintBitsToFloat(w0.zw), intBitsToFloat(w1.w));
  return r;
}

// Coverage of a strip's half-blocks.
uvec4 coverStrip(RegionEdges edges, Rows rows, int strip, ivec2 region, uint onScreen) {
  uvec4 masks = uvec4(0u);
  for (int row = max(rows.first, 4 * strip); row <= min(rows.last, 4 * strip + 3); ++row) {
    uint covered = onScreen;
    if (rows.irregular)
      covered &= irregularRow(push.triangles, push.irregular, push.shading, rows.slot,
                              uint(loadTriangle(push.triangles, rows.slot).flags), push.near, region, row);
    else covered &= rowCoverage(edges, row);
    masks |= (uvec4(covered, covered >> 8, covered >> 16, covered >> 24) & 0xffu) << (8 * (row & 3));
  }
  return masks;
}

void walk(bool write, Span span) {
  const uint self = gl_LocalInvocationIndex;
  const int rowsOnScreen = min(int(push.size.y) - span.region.y, 32);
  const uint onScreen = bitsBetween(0, min(int(push.size.x) - span.region.x, 32) - 1);
  for (uint begin = 0u; begin < span.count; begin += GROUP) {
    if (self == 0u) items = 0u;
    barrier();
    if (begin + self < span.count) {
      Rows rows;
      rows.slot = slotOf(span.bin, span.first + begin + self);
      const RasterTriangle t = loadTriangle(push.triangles, rows.slot);
      rows.irregular = (t.flags & TRIANGLE_IRREGULAR) != 0u;
      const ivec4 box = snappedBox(t.v01.xy, t.v01.zw, t.v2);
      rows.first = rows.irregular ? 0 : max(box.y - span.region.y, 0);
      rows.last = min(rows.irregular ? 31 : box.w - span.region.y, rowsOnScreen - 1);
      if (t.flags != 0u && rows.first <= rows.last) {
        storeEdges(self, rows, regionEdges(t, span.region));
        const uint first = uint(rows.first) / 4u, last_ = uint(rows.last) / 4u;
        uint place = atomicAdd(items, last_ - first + 1u);
        for (uint strip = first; strip <= last_; ++strip) stripItems[place++] = self | strip << 16;
      }
    }
    barrier();
    for (uint k = self; k < items; k += GROUP) {
      const uint item = stripItems[k];
      const int strip = int(item >> 16);
      Rows rows;
      const RegionEdges edges = loadEdges(item & 0xffffu, rows);
      takeStrip(write, span, rows.slot, strip, coverStrip(edges, rows, strip, span.region, onScreen));
    }
    barrier();
  }
}

void writeKept(Span span) {
  for (uint k = gl_LocalInvocationIndex; k < kept; k += GROUP) {
    const uint place = keptPlaces[k];
    writeItem(span.region, keptItems[k].x, keptItems[k].y, place & (HALF_BLOCKS - 1u),
              place >> HALF_BLOCK_BITS);
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
    else if (length > ORDERED_LIST) rank = atomicAdd(lowLists, 1u);
    else if (length > 0u) rank = atomicAdd(orderedLists, 1u);
  }
  barrier();
  if (self == 0u) {
    if (total > 0u) base = atomicAdd(push.counters.c.triHalfBlocks, total);
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
    else if (length > ORDERED_LIST)
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
  span.first = part.number * PART_TRIANGLES;
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
  const uint parts = push.rasterCounters.c.lowBins, firstPart = 0u;
#else
  const uint parts = push.rasterCounters.c.highParts, firstPart = halfBlocksOfFrame() / HALF_BLOCKS;
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
