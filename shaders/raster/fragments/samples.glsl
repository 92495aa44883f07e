// Lanes take the samples of small triangles one after the other and hand them to the pixels that they fall on
// (section 2, phase 3). The includer defines SUBGROUP_SIZE and TEAMS.
#ifndef OITLAB_RASTER_SAMPLES_GLSL
#define OITLAB_RASTER_SAMPLES_GLSL

#include "raster/fragments/bits.glsl"
#include "raster/fragments/team.glsl"

// The triangles of a batch that have samples: slot and mask, and the number of samples before each.
shared uvec2 batch[TEAMS * SUBGROUP_SIZE];
shared uint samplesBefore[TEAMS * SUBGROUP_SIZE];

// A batch of triangles, and how far the lanes have taken its samples.
struct Batch {
  uint at;       // first of the team's places in `batch`
  uint size;     // triangles that have samples
  uint samples;  // of all of them
  uint place;    // in `batch`, of the lane's own triangle, if it has samples
  uint begin;    // samples before it; past the end if it has none
  uint started;  // number of triangles whose first sample was taken
};

// Each lane brings one triangle, or a mask of 0. All lanes of the subgroup must call this. Other lanes may read
// `batch` after the next teamBarrier().
Batch makeBatch(uint slot, uint mask) {
  Batch b;
  b.at = gl_SubgroupID * SUBGROUP_SIZE;
  const uint count = bitCount(mask), end = subgroupInclusiveAdd(count);
  const uvec4 theirs = subgroupBallot(mask != 0u);
  b.place = b.at + subgroupBallotExclusiveBitCount(theirs);
  b.samples = subgroupAdd(count);
  b.size = subgroupBallotBitCount(theirs);
  b.begin = mask != 0u ? end - count : 0xffffffffu;
  b.started = 0u;
  if (mask != 0u) {
    batch[b.place] = uvec2(slot, mask);
    samplesBefore[b.place] = end - count;
  }
  return b;
}

// The lane's sample of [first, first + OWNERS): the triangle's slot and the bit of the pixel. All lanes must call
// this with first = 0, OWNERS, ... in order. The result is meaningless for lanes beyond the last sample.
uvec2 sampleOf(inout Batch b, uint first) {
  const uint lane = gl_SubgroupInvocationID;
  const bool starts = b.begin - first < OWNERS;  // wraps around if it began earlier
  const uint startBits = subgroupOr(starts ? 1u << (b.begin - first) : 0u);
  const uint number = b.started + bitCount(startBits & ((2u << min(lane, 31u)) - 1u)) - 1u;
  b.started += bitCount(startBits);
  uvec2 result = uvec2(0u);
  if (lane < OWNERS && first + lane < b.samples) {
    const uvec2 triangle = batch[b.at + number];
    result = uvec2(triangle.x, nthBit(triangle.y, first + lane - samplesBefore[b.at + number]));
  }
  return result;
}

#endif
