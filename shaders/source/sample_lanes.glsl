// How the lanes of a subgroup of at least 32 take the samples of small triangles, one after the other (LucidRaster,
// section 2, phase 3), and how pixels find theirs. All in registers: shared memory limits how many subgroups run.
#ifndef OITLAB_SOURCE_SAMPLE_LANES_GLSL
#define OITLAB_SOURCE_SAMPLE_LANES_GLSL

#include "raster/blocks/half_block.glsl"
#include "raster/fragments/bits.glsl"

// How far the lanes have taken the samples of a batch, which has one triangle per lane.
struct Progress {
  TriHalfBlock item;  // the lane's
  uint begin;         // samples before those of it; past the end if it has none
  uint started;       // triangles whose first sample was taken
};

// All lanes of the subgroup must call this and the next functions.
Progress beginSamples(TriHalfBlock item) {
  const uint before = subgroupExclusiveAdd(bitCount(item.mask));
  return Progress(item, item.mask != 0u ? before : ~0u, 0u);
}

// The lane's sample of [first, first + OWNERS): the triangle's slot and the bit of the pixel. To be called with
// first = 0, OWNERS, ... in order. The result is meaningless for lanes beyond the last sample.
uvec2 nextSample(inout Progress p, uint first) {
  const uint lane = gl_SubgroupInvocationID;
  const bool starts = p.begin - first < OWNERS;  // wraps around if it began earlier
  const uint startBits = subgroupOr(starts ? 1u << (p.begin - first) : 0u);
  const uint number = p.started + bitCount(startBits & ((2u << min(lane, 31u)) - 1u)) - 1u;
  p.started += bitCount(startBits);
  const uint slot = subgroupShuffle(p.item.triangle, number), mask = subgroupShuffle(p.item.mask, number);
  return uvec2(slot, nthBit(mask, first + lane - subgroupShuffle(p.begin, number)));
}

// The lanes whose sample falls on this lane's pixel. `bit`: of the sample's pixel; `own`: of the lane's.
uint lanesAt(bool exists, uint bit, uint own) {
  uint lanes = subgroupBallot(exists).x;
  [[unroll]] for (uint b = 0u; b < 5u; ++b) {
    const uint set = subgroupBallot((bit & (1u << b)) != 0u).x;
    lanes &= (own & (1u << b)) != 0u ? set : ~set;
  }
  return lanes;
}

#endif
