// The two ways in which fragments come to the pixels of a half-block: from prepared triangles, or as samples that
// lanes took. The includer declares `push` and defines SUBGROUP_SIZE, SMALL_SUBGROUP and TEAMS.
#ifndef OITLAB_LUCID_PIXELS_GLSL
#define OITLAB_LUCID_PIXELS_GLSL

#include "lucid/depth_filter.glsl"
#include "raster/blocks/half_block.glsl"
#include "raster/fragments/prepared.glsl"
#include "raster/fragments/samples.glsl"

shared uint samplesOf[TEAMS * 32u];  // bit i: sample i falls on this pixel

// A lane owns one pixel of each group. Where there are several groups, loops over them are not unrolled.
#define GROUPS (32u / OWNERS)
#if SMALL_SUBGROUP
#define EACH_GROUP [[dont_unroll]]
#else
#define EACH_GROUP [[unroll]]
#endif

// The bit of the lane's pixel of group g in the coverage masks.
uint bitOf(uint g) { return min(gl_SubgroupInvocationID + OWNERS * g, 31u); }

// The bits of group g in the coverage masks.
uint groupMask(uint g) { return (0xffffffffu >> (32u - OWNERS)) << (OWNERS * g); }

// The fragment of a prepared triangle at a pixel. Where the triangle does not cover it, the fragment is not used.
struct Taken {
  Sample f;
  bool kept;   // the fragment exists and must be pushed
  bool blends; // and it is not behind the alpha threshold
};

Taken take(uint at, bool covered, vec2 pixel, float opaque, bool full) {
  const Prepared t = loadPrepared(at);
  Taken taken;
  const float invW = invWOf(t, pixel);
  taken.f.depth = depthOf(push.frame, invW);
  taken.f.id = t.id;
  taken.f.color = vec4(0.0);
  taken.kept = covered && !isHidden(taken.f.depth, opaque);
  taken.blends = taken.kept && !full;
#if HAS_TEXTURES  // a branch is cheaper than texture reads whose result is not used
  if (taken.blends)
#endif
  {
    const bool there = shadePrepared(push.frame, t, pixel, invW, taken.f.color);
    taken.kept = taken.kept && (full || there);
    taken.blends = taken.blends && there;
  }
  return taken;
}

// Pushes the fragments of `count` prepared triangles to a pixel: `bit`, if it is in `own`. The first triangle is at
// place `at` of the batch, and is the first of the team's prepared triangles.
void blendPrepared(inout Pixel p, uint own, uint bit, float opaque, uint at, uint count) {
  const uint lane = gl_SubgroupInvocationID, first = gl_SubgroupID * PREPARED_COUNT;
  const uint pixelBit = own & (1u << bit);
  const vec2 pixel = vec2(pixelOf(bit));
  if (SMALL_SUBGROUP == 0) {
    // In pairs and without branches, so that one fragment's latency hides behind the other's work.
    for (uint k = 0u; k < count; k += 2u) {
      const uint next = min(k + 1u, count - 1u);
      const bool full = isFull(p);
      const Taken t0 = take(first + k, (batch[at + k].y & pixelBit) != 0u, pixel, opaque, full);
      const Taken t1 = take(first + next, (batch[at + next].y & pixelBit) != 0u && next > k, pixel, opaque, full);
      if (t0.kept) pushFragment(p, t0.f);
      p.samples += uint(t0.blends);
      if (t1.kept) pushFragment(p, t1.f);
      p.samples += uint(t1.blends);
    }
  } else {
    // There are several groups of pixels: only the triangles that reach this one.
    const bool reaches = lane < count && (batch[at + min(lane, count - 1u)].y & groupMask(bit / OWNERS)) != 0u;
    for (uint rest = subgroupBallot(reaches).x; rest != 0u; rest &= rest - 1u) {
      const uint k = findLSB(rest);
      const Taken t = take(first + k, (batch[at + k].y & pixelBit) != 0u, pixel, opaque, isFull(p));
      if (t.kept) pushFragment(p, t.f);
      p.samples += uint(t.blends);
    }
  }
}

// Pushes the samples that fell on a pixel to it: `bit`, if it is in `own`.
void blendSamples(inout Pixel p, uint own, uint bit, float opaque) {
  uint arrived = 0u;
  if ((own & (1u << bit)) != 0u) arrived = samplesOf[32u * gl_SubgroupID + bit];
  if (arrived != 0u) samplesOf[32u * gl_SubgroupID + bit] = 0u;
  for (; arrived != 0u; arrived &= arrived - 1u) {
    const Sample f = loadSample(findLSB(arrived));
    if (!isHidden(f.depth, opaque)) {
      p.samples += uint(!isFull(p));
      pushFragment(p, f);
    }
  }
}

#endif
