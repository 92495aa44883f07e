// The strips of four rows that the triangles of a part of a bin reach, as items that the invocations of a
// workgroup share evenly. The including shader defines GROUP and declares `push`.
#ifndef OITLAB_LUCID_STRIPS_GLSL
#define OITLAB_LUCID_STRIPS_GLSL

#include "lucid/lucid_types.h"
#include "raster/coverage.glsl"

#extension GL_KHR_shader_subgroup_arithmetic : require

struct Span {
  Part part;
  ivec2 region;      // the bin's first pixel
  ivec2 extent;      // pixels of it that are on the screen
  uint first, count; // triangles of the bin's list
};

uint slotOf(Part part, uint i) {
  if (i < 2u * part.quads) return 2u * push.entries.at[part.first + i / 2u] + i % 2u;
  return push.entries.at[part.first + i - part.quads];
}

// The part's triangles, in the order of the group's subgroups: their slots, and of each the first strip that
// it reaches, whether its corners are to be turned about, and how many strips those before it reach.
#define RUN ((PART_TRIANGLES + GROUP - 1u) / GROUP)  // triangles of an invocation
shared uint slots[PART_TRIANGLES], begins[PART_TRIANGLES];
#define STRIP_BITS 3
#define TURNED (1u << STRIP_BITS)
#define BEGIN_SHIFT (STRIP_BITS + 1)
shared uint stripSums[GROUP];  // of a subgroup each
shared uint strips;

// What `begins` says of the triangle itself, and how many strips it reaches in the bin.
uvec2 stripsOf(Span span, uint slot) {
  ivec4 box = ivec4(ivec2(0), span.extent - 1);
  uint turned = 0u;
  if (HAS_IRREGULAR == 0 || !isIrregular(slot)) {
    const RasterTriangle t = loadTriangle(push.mesh, slot);
    const int64_t area = signedArea(t.v[0], t.v[1], t.v[2]);
    if (area < 0) turned = TURNED;
    const ivec4 own = snappedBox(t.v[0], t.v[1], t.v[2]) - span.region.xyxy;
    box = area == 0 ? emptyBox : ivec4(max(own.xy, box.xy), min(own.zw, box.zw));
  }
  if (isEmpty(box)) return uvec2(0u);
  const uint first = uint(box.y) / HALF_BLOCK_HEIGHT, last = uint(box.w) / HALF_BLOCK_HEIGHT;
  return uvec2(first | turned, last - first + 1u);
}

// Fills `slots`, `begins` and `strips`. All invocations take part.
void findStrips(Span span) {
  const uint self = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
  uvec2 reached[RUN];
  uint own = 0u;
  [[unroll]] for (uint r = 0u; r < RUN; ++r) {
    const uint number = self * RUN + r;
    reached[r] = uvec2(0u);
    if (number < span.count) {
      const uint slot = slotOf(span.part, span.first + number);
      slots[number] = slot;
      reached[r] = stripsOf(span, slot);
    }
    own += reached[r].y;
  }
  const uint sum = subgroupAdd(own);
  uint before = subgroupExclusiveAdd(own);
  if (subgroupElect()) stripSums[gl_SubgroupID] = sum;
  barrier();
  for (uint s = 0u; s < gl_SubgroupID; ++s) before += stripSums[s];
  [[unroll]] for (uint r = 0u; r < RUN; ++r) {
    const uint number = self * RUN + r;
    if (number < PART_TRIANGLES) begins[number] = before << BEGIN_SHIFT | reached[r].x;
    before += reached[r].y;
  }
  if (gl_SubgroupID == gl_NumSubgroups - 1u && subgroupElect()) {
    uint all = 0u;
    for (uint s = 0u; s < gl_NumSubgroups; ++s) all += stripSums[s];
    strips = all;
  }
  barrier();
}

// Coverage of a strip's half-blocks: a byte of each row is one of each mask.
uvec4 coverStrip(Span span, int strip, uint slot, bool turned) {
  const uint onScreen = bitsBetween(0, span.extent.x - 1);
  uvec4 rows;
#if HAS_IRREGULAR
  if (isIrregular(slot)) {
    [[dont_unroll]] for (int row = 0; row < 4; ++row)
      rows[row] = irregularRow(push.mesh.irregular, slot, nearPlane(push.frame.c.viewProjection), span.region, 4 * strip + row);
  } else
#endif
  {
    RasterTriangle t = loadTriangle(push.mesh, slot);
    if (turned) t = turnAbout(t);
    const RegionEdges edges = regionEdges(t, span.region);
    [[unroll]] for (int row = 0; row < 4; ++row) rows[row] = rowCoverage(edges, 4 * strip + row);
  }
  uvec4 masks = uvec4(0u);
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const uint covered = 4 * strip + row < span.extent.y ? rows[row] & onScreen : 0u;
    masks |= ((uvec4(covered) >> uvec4(0u, 8u, 16u, 24u)) & 0xffu) << (8 * row);
  }
  return masks;
}

// Which of the part's triangles has the strip: the last that begins no later.
uint triangleOf(uint item) {
  uint number = 0u;
  [[unroll]] for (uint step = PART_TRIANGLES / 2u; step > 0u; step /= 2u)
    if (begins[number + step] >> BEGIN_SHIFT <= item) number += step;
  return number;
}

#endif
