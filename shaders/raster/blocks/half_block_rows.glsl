// The half-block rows (rows of half-blocks, 32 x 4 pixels) that the triangles of a segment reach, as items that are
// divided evenly among the invocations of a workgroup. The includer defines GROUP and declares `push`.
#ifndef OITLAB_RASTER_HALF_BLOCK_ROWS_GLSL
#define OITLAB_RASTER_HALF_BLOCK_ROWS_GLSL

#include "raster/blocks/block_types.h"
#include "raster/coverage.glsl"

#extension GL_KHR_shader_subgroup_arithmetic : require

struct Span {
  Segment segment;
  ivec2 region;      // the bin's first pixel
  ivec2 extent;      // pixels of it that are on the screen
  uint first, count; // triangles of the bin's list
};

uint slotOf(Segment segment, uint i) {
  if (i < 2u * segment.quads) return 2u * push.entries.at[segment.first + i / 2u] + i % 2u;
  return push.entries.at[segment.first + i - segment.quads];
}

// Per triangle of the segment, in the order of the workgroup's subgroups: its slot, and in one word the first
// half-block row that it reaches, whether its corners must be flipped, and the number of half-block rows that the
// triangles before it reach.
#define RUN ((SEGMENT_TRIANGLES + GROUP - 1u) / GROUP)  // triangles per invocation
shared uint slots[SEGMENT_TRIANGLES], begins[SEGMENT_TRIANGLES];
#define ROW_BITS 3
#define FLIPPED (1u << ROW_BITS)
#define BEGIN_SHIFT (ROW_BITS + 1)
shared uint rowSums[GROUP];  // one per subgroup
shared uint halfBlockRows;

// x: the triangle's own bits of `begins`; y: the number of half-block rows that it reaches in the bin.
uvec2 halfBlockRowsOf(Span span, uint slot) {
  ivec4 box = ivec4(ivec2(0), span.extent - 1);
  uint flipped = 0u;
  if (HAS_UNSNAPPED == 0 || !isUnsnapped(slot)) {
    const RasterTriangle t = loadTriangle(push.mesh, slot);
    const int64_t area = signedArea(t.v[0], t.v[1], t.v[2]);
    if (area < 0) flipped = FLIPPED;
    const ivec4 own = snappedBox(t.v[0], t.v[1], t.v[2]) - span.region.xyxy;
    box = area == 0 ? emptyBox : ivec4(max(own.xy, box.xy), min(own.zw, box.zw));
  }
  if (isEmpty(box)) return uvec2(0u);
  const uint first = uint(box.y) / HALF_BLOCK_HEIGHT, last = uint(box.w) / HALF_BLOCK_HEIGHT;
  return uvec2(first | flipped, last - first + 1u);
}

// Fills `slots`, `begins` and `halfBlockRows`. All invocations must call this.
void findHalfBlockRows(Span span) {
  const uint self = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
  uvec2 reached[RUN];
  uint own = 0u;
  [[unroll]] for (uint r = 0u; r < RUN; ++r) {
    const uint number = self * RUN + r;
    reached[r] = uvec2(0u);
    if (number < span.count) {
      const uint slot = slotOf(span.segment, span.first + number);
      slots[number] = slot;
      reached[r] = halfBlockRowsOf(span, slot);
    }
    own += reached[r].y;
  }
  const uint sum = subgroupAdd(own);
  uint before = subgroupExclusiveAdd(own);
  if (subgroupElect()) rowSums[gl_SubgroupID] = sum;
  barrier();
  for (uint s = 0u; s < gl_SubgroupID; ++s) before += rowSums[s];
  [[unroll]] for (uint r = 0u; r < RUN; ++r) {
    const uint number = self * RUN + r;
    if (number < SEGMENT_TRIANGLES) begins[number] = before << BEGIN_SHIFT | reached[r].x;
    before += reached[r].y;
  }
  if (gl_SubgroupID == gl_NumSubgroups - 1u && subgroupElect()) {
    uint all = 0u;
    for (uint s = 0u; s < gl_NumSubgroups; ++s) all += rowSums[s];
    halfBlockRows = all;
  }
  barrier();
}

// Coverage masks of the four half-blocks of a half-block row: byte c of each row of pixels belongs to mask c.
uvec4 coverHalfBlockRow(Span span, int halfBlockRow, uint slot, bool flipped) {
  const uint onScreen = bitsBetween(0, span.extent.x - 1);
  uvec4 rows;
#if HAS_UNSNAPPED
  if (isUnsnapped(slot)) {
    [[dont_unroll]] for (int row = 0; row < 4; ++row)
      rows[row] = unsnappedRow(push.mesh.unsnapped, slot, nearPlane(push.frame.c.viewProjection), span.region,
                               4 * halfBlockRow + row);
  } else
#endif
  {
    RasterTriangle t = loadTriangle(push.mesh, slot);
    if (flipped) t = flip(t);
    const RegionEdges edges = regionEdges(t, span.region);
    [[unroll]] for (int row = 0; row < 4; ++row) rows[row] = rowCoverage(edges, 4 * halfBlockRow + row);
  }
  uvec4 masks = uvec4(0u);
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const uint covered = 4 * halfBlockRow + row < span.extent.y ? rows[row] & onScreen : 0u;
    masks |= ((uvec4(covered) >> uvec4(0u, 8u, 16u, 24u)) & 0xffu) << (8 * row);
  }
  return masks;
}

// The triangle of the segment that item belongs to: the last one that begins at or before it.
uint triangleOf(uint item) {
  uint number = 0u;
  [[unroll]] for (uint step = SEGMENT_TRIANGLES / 2u; step > 0u; step /= 2u)
    if (begins[number + step] >> BEGIN_SHIFT <= item) number += step;
  return number;
}

#endif
