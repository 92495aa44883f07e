#version 460
// Stage 3, phases 1 and 2 up to the sort: the list of tri-half-blocks of every half-block. A workgroup
// a part of a bin. The paper goes from block-rows to blocks to half-blocks through scratch memory; here
// rows of pixels become half-block masks at once, in shared memory, and go into lists of just the right
// size.
//
// FIRST_LIST: ORDERED_LIST, or 0 where all lists go through the depth filter.
//
// PASS 0: bins of one part: counts and writes. PASS 1: counts bins of several parts, the last of which
// makes room for all. PASS 2: writes these, from what PASS 1 kept.
#include "lucid/lucid_types.h"
#include "lucid/sort_key.glsl"

layout(local_size_x = GROUP) in;
layout(push_constant, scalar) uniform Push { BlocksPush push; };

#include "lucid/strips.glsl"

// What of a part fits is kept from counting to writing; what does not is rasterized again. Parts have
// some 360 in a hairball, more in others: more room would serve a few, and cost all of them the shared
// memory (docs/performance.md).
#define KEPT 512u
shared uint keptMasks[KEPT];
shared uint keptPlaces[KEPT];  // half-block, triangle of the part, place in the half-block's list
#define TRIANGLE_SHIFT 5  // above the half-block: PART_TRIANGLES
#define PLACE_SHIFT 13

shared uint counts[HALF_BLOCKS], starts[HALF_BLOCKS], cursors[HALF_BLOCKS], lengths[HALF_BLOCKS];
shared uint kept, keptFirst, base, total;
shared uint orderedLists, lowLists, highLists, firstOrdered, firstLow, firstHigh;
shared uint last;

ivec2 cornerIn(ivec2 region, uint block) {
  return region + ivec2(block % HALF_BLOCKS_ACROSS * HALF_BLOCK_WIDTH,
                        block / HALF_BLOCKS_ACROSS * HALF_BLOCK_HEIGHT);
}

uint keyOf(ivec2 region, uint slot, uint mask, uint block) {
  return sortKey(push.mesh, slot, cornerIn(region, block), mask);
}

void writeItem(uint slot, uint mask, uint key, uint block, uint place) {
  push.list.at[starts[block] + place] = uvec2(slot, mask);
  push.keys.at[starts[block] + place] = key;
}

// `number`: of the triangle in its part.
void takeStrip(bool write, Span span, uint slot, uint number, int strip, uvec4 masks) {
#if PASS != 2
  uint k = 0u;
  if (!write) k = atomicAdd(kept, uint(dot(vec4(notEqual(masks, uvec4(0u))), vec4(1.0))));
#endif
  [[unroll]] for (uint c = 0u; c < HALF_BLOCKS_ACROSS; ++c) {
    if (masks[c] == 0u) continue;
    const uint block = uint(strip) * HALF_BLOCKS_ACROSS + c;
    if (write) {
      writeItem(slot, masks[c], keyOf(span.region, slot, masks[c], block), block, atomicAdd(cursors[block], 1u));
      continue;
    }
#if PASS != 2
    const uint place = atomicAdd(counts[block], 1u);
    if (k < KEPT) {
      keptMasks[k] = masks[c];
      keptPlaces[k] = block | number << TRIANGLE_SHIFT | place << PLACE_SHIFT;
    }
    ++k;
#endif
  }
}

// Strips are shared out evenly, however tall the triangles: lanes of a subgroup wait for each other.
void walk(bool write, Span span) {
  for (uint i = gl_LocalInvocationIndex; i < strips; i += GROUP) {
    const uint number = triangleOf(i), slot = slots[number], begin = begins[number];
    const int strip = int(bitfieldExtract(begin, 0, STRIP_BITS) + i - (begin >> BEGIN_SHIFT));
    takeStrip(write, span, slot, number, strip, coverStrip(span, strip, slot, (begin & TURNED) != 0u));
  }
}

// What is kept here, as it is written or handed on to PASS 2.
uvec4 keptItem(Span span, uint k) {
  const uint place = keptPlaces[k], block = place & (HALF_BLOCKS - 1u);
  const uint slot = slots[bitfieldExtract(place, TRIANGLE_SHIFT, PLACE_SHIFT - TRIANGLE_SHIFT)];
  return uvec4(keptMasks[k], slot, keyOf(span.region, slot, keptMasks[k], block),
               block | place >> PLACE_SHIFT << KEPT_PLACE_SHIFT);
}

void writeKeptItem(uvec4 item) {
  writeItem(item.y, item.x, item.z, item.w & (HALF_BLOCKS - 1u), item.w >> KEPT_PLACE_SHIFT);
}

KeptBuffer keptBuffer() { return KeptBuffer(uint64_t(push.list) + 8ul * push.listCapacity); }

uint halfBlocksOfFrame() {
  const uvec2 grid = (push.frame.c.size + BIN_SIZE - 1u) / BIN_SIZE;
  return grid.x * grid.y * HALF_BLOCKS;
}

// Makes room for the lists of a bin, of these lengths: `starts`. All invocations take part.
void makeLists(uint number) {
  const uint self = gl_LocalInvocationIndex;
  if (self == 0u) orderedLists = lowLists = highLists = 0u;
  barrier();
  uint rank = 0u, before = 0u;
  if (self < HALF_BLOCKS) {
    // Not all at once: that took 64 registers, and a third of the workgroups that there is room for.
    [[dont_unroll]] for (uint b = 0u; b < self; ++b) before += lengths[b];
    const uint length = lengths[self];
    if (self == HALF_BLOCKS - 1u) total = before + length;
    if (length > LOW_LIST) rank = atomicAdd(highLists, 1u);
    else if (length > FIRST_LIST) rank = atomicAdd(lowLists, 1u);
    else if (length > 0u) rank = atomicAdd(orderedLists, 1u);
  }
  barrier();
  if (self == 0u) {
    base = total > 0u ? atomicAdd(push.counters.c.triHalfBlocks, total) : 0u;
    if (base + total > push.listCapacity) atomicMax(push.counters.c.overflow, 1u);
    if (orderedLists > 0u) firstOrdered = atomicAdd(push.counters.c.orderedLists, orderedLists);
    if (lowLists > 0u) firstLow = atomicAdd(push.counters.c.lowLists, lowLists);
    if (highLists > 0u) firstHigh = atomicAdd(push.counters.c.highLists, highLists);
    // Workgroups for what there is so far: the most that any says.
    const uint ordered = orderedLists > 0u ? (firstOrdered + orderedLists + ORDERED_TEAMS - 1u) / ORDERED_TEAMS : 0u;
    const uint low = lowLists > 0u ? (firstLow + lowLists + LOW_TEAMS - 1u) / LOW_TEAMS : 0u;
    atomicMax(push.counters.c.ordered.x, min(ordered, MAX_GROUPS));
    atomicMax(push.counters.c.ordered.y, (ordered + MAX_GROUPS - 1u) / MAX_GROUPS);
    atomicMax(push.counters.c.low.x, min(low, MAX_GROUPS));
    if (highLists > 0u) atomicMax(push.counters.c.high.x, min(firstHigh + highLists, MAX_GROUPS));
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
  const uvec2 grid = (push.frame.c.size + BIN_SIZE - 1u) / BIN_SIZE;
  Span span;
  span.part = part;
  span.region = ivec2(uvec2(part.bin % grid.x, part.bin / grid.x) * BIN_SIZE);
  span.extent = min(ivec2(push.frame.c.size) - span.region, ivec2(BIN_SIZE));
  span.first = part.number * PART_TRIANGLES;  // at most 2^(PLACE_SHIFT - TRIANGLE_SHIFT)
  span.count = min(2u * part.quads + part.triangles - span.first, PART_TRIANGLES);
  if (self < HALF_BLOCKS) counts[self] = cursors[self] = 0u;
  if (self == 0u) kept = 0u;
#if PASS == 2
  const uint keptThere = push.partLists.at[place].kept, keptAt = push.partLists.at[place].keptFirst;
  const bool again = keptThere > KEPT;
  if (again) findStrips(span);
#else
  findStrips(span);
#endif
  const uint own = part.bin * HALF_BLOCKS + self;
#if PASS != 2
  walk(false, span);
  barrier();
#endif
#if PASS == 0
  if (self < HALF_BLOCKS) lengths[self] = counts[self];
  makeLists(part.bin);
  if (base + total > push.listCapacity) return;  // counted all the same: the host makes room
  if (kept > KEPT) {
    walk(true, span);
  } else {
    for (uint k = self; k < kept; k += GROUP) writeKeptItem(keptItem(span, k));
  }
#elif PASS == 1
  if (self < HALF_BLOCKS) {
    push.partLists.at[place].first[self] = atomicAdd(push.binBlocks.at[own].count, counts[self]);
    memoryBarrierBuffer();
  }
  barrier();
  const uint parts = (2u * part.quads + part.triangles + PART_TRIANGLES - 1u) / PART_TRIANGLES;
  if (self == 0u) {
    memoryBarrierBuffer();  // of what the others released, by the one invocation that says so
    last = uint(atomicAdd(push.binBlocks.at[part.bin * HALF_BLOCKS].partsDone, 1u) + 1u == parts);
    memoryBarrierBuffer();
    keptFirst = kept > KEPT ? 0u : atomicAdd(push.counters.c.kept, kept);
    if (kept <= KEPT && keptFirst + kept > push.keptCapacity) atomicMax(push.counters.c.overflow, 1u);
    push.partLists.at[place].kept = kept;
    push.partLists.at[place].keptFirst = keptFirst;
  }
  barrier();
  if (kept <= KEPT && keptFirst + kept <= push.keptCapacity)
    for (uint k = self; k < kept; k += GROUP) keptBuffer().at[keptFirst + k] = keptItem(span, k);
  if (last == 0u) return;  // the same for all
  if (self < HALF_BLOCKS) {
    memoryBarrierBuffer();
    lengths[self] = atomicAdd(push.binBlocks.at[own].count, 0u);
  }
  makeLists(part.bin);
  if (self < HALF_BLOCKS) push.binBlocks.at[own].first = starts[self];
#else
  if (self < HALF_BLOCKS)
    starts[self] = push.binBlocks.at[own].first + push.partLists.at[place].first[self];
  barrier();
  if (again) {
    walk(true, span);
  } else {
    for (uint k = self; k < keptThere; k += GROUP) writeKeptItem(keptBuffer().at[keptAt + k]);
  }
#endif
}

void main() {
#if PASS == 0
  const uint parts = push.rasterCounters.c.lowBins, firstPart = 0u, groupCount = push.rasterCounters.c.low.x;
#else
  const uint parts = push.rasterCounters.c.highParts, firstPart = halfBlocksOfFrame() / HALF_BLOCKS;
  const uint groupCount = push.rasterCounters.c.high.x;
#endif
#if PASS == 2
  if (push.counters.c.overflow != 0u) return;
#else
  if (gl_WorkGroupID.x == 0u && gl_LocalInvocationIndex == 0u) {
    push.counters.c.ordered.z = 1u;
    push.counters.c.low.y = push.counters.c.low.z = 1u;
    push.counters.c.high.y = push.counters.c.high.z = 1u;
    push.counters.c.repair.y = push.counters.c.repair.z = 1u;
    push.counters.c.deep.z = push.counters.c.deepResolve.y = push.counters.c.deepResolve.z = 1u;
  }
#endif
  for (uint i = gl_WorkGroupID.x; i < parts; i += groupCount) {
    goThrough(push.parts.at[firstPart + i], i);
    barrier();  // the shared counts are used anew
  }
}
