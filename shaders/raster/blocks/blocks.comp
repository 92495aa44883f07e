#version 460
// Stage 3, phases 1 and 2 up to the sort: makes the list of tri-half-blocks of every half-block. One workgroup
// per segment of a bin. The paper goes from block rows to blocks to half-blocks through scratch memory. Here,
// rows of pixels become half-block masks directly in shared memory, and lists are allocated at their exact size.
//
// Lists of up to FIRST_LIST count as short, others of up to MEDIUM_LIST as medium, others as long. KEY says what is
// stored beside each tri-half-block.
//
// PASS: COUNT_AND_WRITE_LOW counts and writes bins of one segment. COUNT_HIGH counts bins of several segments;
// the last workgroup of a bin allocates its lists. WRITE_HIGH writes them, from what COUNT_HIGH cached.
#include "raster/blocks/block_types.h"
#include "raster/blocks/sort_key.glsl"

layout(local_size_x = GROUP) in;
layout(push_constant, scalar) uniform Push { BlocksPush push; };

#include "raster/blocks/half_block_rows.glsl"

// The tri-half-blocks of a segment are cached from counting to writing. A segment that has more is rasterized
// again. In the hairball a segment has about 360, in other scenes some have more. A larger cache would help few
// segments and take shared memory from all of them (docs/performance_log.md).
#define CACHE_SIZE 512u
shared uint cachedMasks[CACHE_SIZE];
shared uint cachedPlaces[CACHE_SIZE];  // half-block, triangle of the segment, place in the half-block's list
#define TRIANGLE_SHIFT 5  // the half-block lies below; 8 bits, for SEGMENT_TRIANGLES
#define PLACE_SHIFT 13

shared uint counts[HALF_BLOCKS], starts[HALF_BLOCKS], cursors[HALF_BLOCKS], lengths[HALF_BLOCKS];
shared uint cached, cachedFirst, base, total;
shared uint shortLists, mediumLists, longLists, longest, firstShort, firstMedium, firstLong;
shared uint last;

ivec2 cornerIn(ivec2 region, uint block) {
  return region + ivec2(block % HALF_BLOCKS_ACROSS * HALF_BLOCK_WIDTH,
                        block / HALF_BLOCKS_ACROSS * HALF_BLOCK_HEIGHT);
}

uint keyOf(ivec2 region, uint slot, uint mask, uint block) {
#if KEY == KEY_DEPTH
  return sortKey(push.mesh, slot, cornerIn(region, block), mask);
#elif KEY == KEY_ID
  return idOfTriangle(push.mesh, slot);
#else
  return 0u;
#endif
}

void writeItem(uint slot, uint mask, uint key, uint block, uint place) {
  push.list.at[starts[block] + place] = uvec2(slot, mask);
#if KEY != KEY_NONE
  push.keys.at[starts[block] + place] = key;
#endif
}

// `number`: index of the triangle in its segment.
void takeHalfBlockRow(bool write, Span span, uint slot, uint number, int halfBlockRow, uvec4 masks) {
#if PASS != WRITE_HIGH
  uint k = 0u;
  if (!write) k = atomicAdd(cached, uint(dot(vec4(notEqual(masks, uvec4(0u))), vec4(1.0))));
#endif
  [[unroll]] for (uint c = 0u; c < HALF_BLOCKS_ACROSS; ++c) {
    if (masks[c] == 0u) continue;
    const uint block = uint(halfBlockRow) * HALF_BLOCKS_ACROSS + c;
    if (write) {
      writeItem(slot, masks[c], keyOf(span.region, slot, masks[c], block), block, atomicAdd(cursors[block], 1u));
      continue;
    }
#if PASS != WRITE_HIGH
    const uint place = atomicAdd(counts[block], 1u);
    if (k < CACHE_SIZE) {
      cachedMasks[k] = masks[c];
      cachedPlaces[k] = block | number << TRIANGLE_SHIFT | place << PLACE_SHIFT;
    }
    ++k;
#endif
  }
}

// All invocations get the same number of half-block rows, however tall the triangles are, because the lanes of a
// subgroup wait for each other.
void walk(bool write, Span span) {
  for (uint i = gl_LocalInvocationIndex; i < halfBlockRows; i += GROUP) {
    const uint number = triangleOf(i), slot = slots[number], begin = begins[number];
    const int halfBlockRow = int(bitfieldExtract(begin, 0, ROW_BITS) + i - (begin >> BEGIN_SHIFT));
    takeHalfBlockRow(write, span, slot, number, halfBlockRow,
                     coverHalfBlockRow(span, halfBlockRow, slot, (begin & FLIPPED) != 0u));
  }
}

// Cached item k, in the form that is written here or handed to WRITE_HIGH.
uvec4 cachedItem(Span span, uint k) {
  const uint place = cachedPlaces[k], block = place & (HALF_BLOCKS - 1u);
  const uint slot = slots[bitfieldExtract(place, TRIANGLE_SHIFT, PLACE_SHIFT - TRIANGLE_SHIFT)];
  return uvec4(cachedMasks[k], slot, keyOf(span.region, slot, cachedMasks[k], block),
               block | place >> PLACE_SHIFT << CACHED_PLACE_SHIFT);
}

void writeCachedItem(uvec4 item) {
  writeItem(item.y, item.x, item.z, item.w & (HALF_BLOCKS - 1u), item.w >> CACHED_PLACE_SHIFT);
}

CachedBuffer cachedBuffer() { return CachedBuffer(uint64_t(push.list) + 8ul * push.listCapacity); }

uint halfBlocksOfFrame() {
  const uvec2 grid = (push.frame.c.size + BIN_SIZE - 1u) / BIN_SIZE;
  return grid.x * grid.y * HALF_BLOCKS;
}

#if COUNT_ALL
// Dispatches over lists of all kinds.
void countAll() {
  const uint lists = shortLists + mediumLists + longLists;
  if (lists == 0u) return;
  const uint groups = (atomicAdd(push.counters.c.allLists, lists) + lists + SHORT_TEAMS - 1u) / SHORT_TEAMS;
  atomicMax(push.counters.c.allGroups.x, min(groups, MAX_GROUPS));
  atomicMax(push.counters.c.allGroups.y, (groups + MAX_GROUPS - 1u) / MAX_GROUPS);
  if (longLists == 0u) return;
  const uint rows = min(firstLong + longLists, MAX_GROUPS);
  atomicMax(push.counters.c.runGroups.x, min((longest + SORTED_RUN - 1u) / SORTED_RUN, MAX_GROUPS));
  atomicMax(push.counters.c.runGroups.y, rows);
  atomicMax(push.counters.c.mergeGroups.x, min((longest + MERGE_GROUP - 1u) / MERGE_GROUP, MAX_GROUPS));
  atomicMax(push.counters.c.mergeGroups.y, rows);
}
#endif

// Allocates the lists of a bin, from `lengths` to `starts`. All invocations must call this.
void makeLists(uint number) {
  const uint self = gl_LocalInvocationIndex;
  if (self == 0u) shortLists = mediumLists = longLists = longest = 0u;
  barrier();
  uint rank = 0u, before = 0u;
  if (self < HALF_BLOCKS) {
    // Unrolled, this took 64 registers, and a third fewer workgroups fitted on the GPU.
    [[dont_unroll]] for (uint b = 0u; b < self; ++b) before += lengths[b];
    const uint length = lengths[self];
    if (self == HALF_BLOCKS - 1u) total = before + length;
    if (length > MEDIUM_LIST) {
      rank = atomicAdd(longLists, 1u);
      atomicMax(longest, length);
    } else if (length > FIRST_LIST) rank = atomicAdd(mediumLists, 1u);
    else if (length > 0u) rank = atomicAdd(shortLists, 1u);
  }
  barrier();
  if (self == 0u) {
    base = total > 0u ? atomicAdd(push.counters.c.triHalfBlocks, total) : 0u;
    if (base + total > push.listCapacity) atomicMax(push.counters.c.overflow, 1u);
    if (shortLists > 0u) firstShort = atomicAdd(push.counters.c.shortLists, shortLists);
    if (mediumLists > 0u) firstMedium = atomicAdd(push.counters.c.mediumLists, mediumLists);
    if (longLists > 0u) {
      firstLong = atomicAdd(push.counters.c.longLists, longLists);
      atomicMax(push.counters.c.longest, longest);
    }
    // Workgroups for all lists so far; the maximum over all bins remains.
    const uint ofShort = shortLists > 0u ? (firstShort + shortLists + SHORT_TEAMS - 1u) / SHORT_TEAMS : 0u;
    const uint ofMedium = mediumLists > 0u ? (firstMedium + mediumLists + MEDIUM_TEAMS - 1u) / MEDIUM_TEAMS : 0u;
    atomicMax(push.counters.c.shortGroups.x, min(ofShort, MAX_GROUPS));
    atomicMax(push.counters.c.shortGroups.y, (ofShort + MAX_GROUPS - 1u) / MAX_GROUPS);
    atomicMax(push.counters.c.mediumGroups.x, min(ofMedium, MAX_GROUPS));
    if (longLists > 0u) atomicMax(push.counters.c.longGroups.x, min(firstLong + longLists, MAX_GROUPS));
#if COUNT_ALL
    countAll();
#endif
  }
  barrier();
  if (self < HALF_BLOCKS) {
    const uint length = lengths[self];
    starts[self] = base + before;
    const HalfBlock block = HalfBlock(number * HALF_BLOCKS + self, base + before, length);
    if (length > MEDIUM_LIST)
      push.blocks.at[halfBlocksOfFrame() - 1u - (firstLong + rank)] = block;
    else if (length > FIRST_LIST)
      push.medium.at[firstMedium + rank] = PixelJob(block, 0xffffffffu);
    else if (length > 0u)
      push.blocks.at[firstShort + rank] = block;
  }
  barrier();
}

// `place`: index of the segment among those of high bins.
void goThrough(Segment segment, uint place) {
  const uint self = gl_LocalInvocationIndex;
  const uvec2 grid = (push.frame.c.size + BIN_SIZE - 1u) / BIN_SIZE;
  Span span;
  span.segment = segment;
  span.region = ivec2(uvec2(segment.bin % grid.x, segment.bin / grid.x) * BIN_SIZE);
  span.extent = min(ivec2(push.frame.c.size) - span.region, ivec2(BIN_SIZE));
  span.first = segment.number * SEGMENT_TRIANGLES;  // at most 2^(PLACE_SHIFT - TRIANGLE_SHIFT)
  span.count = min(2u * segment.quads + segment.triangles - span.first, SEGMENT_TRIANGLES);
  if (self < HALF_BLOCKS) counts[self] = cursors[self] = 0u;
  if (self == 0u) cached = 0u;
#if PASS == WRITE_HIGH
  const uint cachedThere = push.segmentLists.at[place].cached, cachedAt = push.segmentLists.at[place].cachedFirst;
  const bool again = cachedThere > CACHE_SIZE;
  if (again) findHalfBlockRows(span);
#else
  findHalfBlockRows(span);
#endif
  const uint own = segment.bin * HALF_BLOCKS + self;
#if PASS != WRITE_HIGH
  walk(false, span);
  barrier();
#endif
#if PASS == COUNT_AND_WRITE_LOW
  if (self < HALF_BLOCKS) lengths[self] = counts[self];
  makeLists(segment.bin);
  if (base + total > push.listCapacity) return;  // counted anyway: the host allocates more
  if (cached > CACHE_SIZE) {
    walk(true, span);
  } else {
    for (uint k = self; k < cached; k += GROUP) writeCachedItem(cachedItem(span, k));
  }
#elif PASS == COUNT_HIGH
  if (self < HALF_BLOCKS) {
    push.segmentLists.at[place].first[self] = atomicAdd(push.binBlocks.at[own].count, counts[self]);
    memoryBarrierBuffer();
  }
  barrier();
  const uint segments = (2u * segment.quads + segment.triangles + SEGMENT_TRIANGLES - 1u) / SEGMENT_TRIANGLES;
  if (self == 0u) {
    memoryBarrierBuffer();  // acquires what the other workgroups released
    last = uint(atomicAdd(push.binBlocks.at[segment.bin * HALF_BLOCKS].segmentsDone, 1u) + 1u == segments);
    memoryBarrierBuffer();
    cachedFirst = cached > CACHE_SIZE ? 0u : atomicAdd(push.counters.c.cached, cached);
    if (cached <= CACHE_SIZE && cachedFirst + cached > push.cachedCapacity) atomicMax(push.counters.c.overflow, 1u);
    push.segmentLists.at[place].cached = cached;
    push.segmentLists.at[place].cachedFirst = cachedFirst;
  }
  barrier();
  if (cached <= CACHE_SIZE && cachedFirst + cached <= push.cachedCapacity)
    for (uint k = self; k < cached; k += GROUP) cachedBuffer().at[cachedFirst + k] = cachedItem(span, k);
  if (last == 0u) return;  // the same for all
  if (self < HALF_BLOCKS) {
    memoryBarrierBuffer();
    lengths[self] = atomicAdd(push.binBlocks.at[own].count, 0u);
  }
  makeLists(segment.bin);
  if (self < HALF_BLOCKS) push.binBlocks.at[own].first = starts[self];
#else
  if (self < HALF_BLOCKS)
    starts[self] = push.binBlocks.at[own].first + push.segmentLists.at[place].first[self];
  barrier();
  if (again) {
    walk(true, span);
  } else {
    for (uint k = self; k < cachedThere; k += GROUP) writeCachedItem(cachedBuffer().at[cachedAt + k]);
  }
#endif
}

void main() {
#if PASS == COUNT_AND_WRITE_LOW
  const uint segments = push.rasterCounters.c.lowBins, firstSegment = 0u, groupCount = push.rasterCounters.c.low.x;
#else
  const uint segments = push.rasterCounters.c.highSegments, firstSegment = halfBlocksOfFrame() / HALF_BLOCKS;
  const uint groupCount = push.rasterCounters.c.high.x;
#endif
#if PASS == WRITE_HIGH
  if (push.counters.c.overflow != 0u) return;
#else
  if (gl_WorkGroupID.x == 0u && gl_LocalInvocationIndex == 0u) {
    push.counters.c.shortGroups.z = 1u;
    push.counters.c.mediumGroups.y = push.counters.c.mediumGroups.z = 1u;
    push.counters.c.longGroups.y = push.counters.c.longGroups.z = 1u;
    push.counters.c.allGroups.z = push.counters.c.runGroups.z = push.counters.c.mergeGroups.z = 1u;
  }
#endif
  for (uint i = gl_WorkGroupID.x; i < segments; i += groupCount) {
    goThrough(push.segments.at[firstSegment + i], i);
    barrier();  // before the shared counts are used again
  }
}
