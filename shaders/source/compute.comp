#version 460
// The compute source: one subgroup (a "team") goes through the list of a half-block, and hands the fragments to a
// fragment program (source/fragment.glsl).
//
// Where a pixel has an owner (ACCESS_BLENDED, ACCESS_EXCLUSIVE), one lane keeps its state in registers. In subgroups of
// fewer than 32 lanes it owns several pixels; in subgroups of 64 lanes half of the lanes own none.
#include "common/bindings.glsl"
#include "raster/blocks/half_block.glsl"
#include "raster/fragments/prepared.glsl"
#include "raster/fragments/samples.glsl"
#include "source/compute_types.h"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;

struct SourceFragment {
  Prepared triangle;
  vec2 place;  // in the half-block
  float invW;
  bool isShaded;  // by another lane
  vec4 color;     // then
};
#include "source/fragment.glsl"

#include "FRAGMENT_PROGRAM"

#include "source/owners.glsl"

bool shadeFragment(Fragment f, out vec4 color) {
  color = f.source.color;
  if (f.source.isShaded) return true;
  return shadePrepared(push.frame, f.source.triangle, f.source.place, f.source.invW, color);
}

float viewDistance(Fragment f) { return push.frame.c.viewProjection[3][2] / f.depth; }

bool hasCutoff(Fragment f) { return !f.source.isShaded && hasCutoff(f.source.triangle); }

Fragment fragmentAt(ivec2 corner, uint bit, float depth, uint id) {
  Fragment f;
  f.pixel = uvec2(corner) + pixelOf(bit);
  f.index = f.pixel.y * push.frame.c.size.x + f.pixel.x;
  f.depth = depth;
  f.id = id;
  f.samples = 1u;
  f.source.place = vec2(pixelOf(bit));
  f.source.isShaded = false;
  f.source.color = vec4(0.0);
  return f;
}

SourceBuffer source() { return SourceBuffer(uint64_t(push.frame)); }

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

#if ACCESS == ACCESS_BLENDED && HAS_TEXTURES == 0
// Without branches, so that the latency of one fragment hides behind the work of another.
#define IN_PAIRS 1

Contributed contributionAt(ivec2 corner, uint bit, float opaque, uint at, bool covered) {
  const Prepared t = loadPrepared(at);
  const float invW = invWOf(t, vec2(pixelOf(bit))), depth = depthOf(push.frame, invW);
  Fragment f = fragmentAt(corner, bit, depth, idOf(t));
  f.source.triangle = t;
  f.source.invW = invW;
  return contributed(f, covered && !isHidden(depth, opaque));
}
#else
#define IN_PAIRS 0
#endif

// Hands the fragment of a prepared triangle at the lane's pixel over.
void deliverPrepared(inout Owner owner, ivec2 corner, uint bit, float opaque, uint at) {
  const Prepared t = loadPrepared(at);
  const float invW = invWOf(t, vec2(pixelOf(bit))), depth = depthOf(push.frame, invW);
  if (isHidden(depth, opaque)) return;
  Fragment f = fragmentAt(corner, bit, depth, idOf(t));
  f.source.triangle = t;
  f.source.invW = invW;
  take(owner, f);
}

// `count` prepared triangles, from place `at` of the batch on: those that cover the lane's pixel.
void deliverBatch(inout Owner owner, ivec2 corner, uint bit, float opaque, uint at, uint count) {
  const uint lane = gl_SubgroupInvocationID, first = gl_SubgroupID * PREPARED_COUNT;
  const uint pixelBit = lane < OWNERS ? 1u << bit : 0u;
  if (SMALL_SUBGROUP == 0) {
#if IN_PAIRS
    for (uint k = 0u; k < count; k += 2u) {
      const uint next = min(k + 1u, count - 1u);
      const bool second = (batch[at + next].y & pixelBit) != 0u && next > k;
      const Contributed c0 = contributionAt(corner, bit, opaque, first + k, (batch[at + k].y & pixelBit) != 0u);
      const Contributed c1 = contributionAt(corner, bit, opaque, first + next, second);
      combine(owner, c0);
      combine(owner, c1);
    }
#else
    for (uint k = 0u; k < count; ++k)
      if ((batch[at + k].y & pixelBit) != 0u) deliverPrepared(owner, corner, bit, opaque, first + k);
#endif
  } else {
    // There are several groups of pixels: only the triangles that reach this one.
    const bool reaches = lane < count && (batch[at + min(lane, count - 1u)].y & groupMask(bit / OWNERS)) != 0u;
    for (uint rest = subgroupBallot(reaches).x; rest != 0u; rest &= rest - 1u) {
      const uint k = findLSB(rest);
      if ((batch[at + k].y & pixelBit) != 0u) deliverPrepared(owner, corner, bit, opaque, first + k);
    }
  }
}

// The samples of small triangles, one per lane. With owners, lanes shade them and hand them to the pixels' owners.
void deliverSamples(inout Owner owner, inout Batch b, ivec2 corner, float opaque) {
  const uint lane = gl_SubgroupInvocationID;
  for (uint chunk = 0u; chunk < b.samples; chunk += OWNERS) {
    const uvec2 hit = sampleOf(b, chunk);
    const bool takes = lane < OWNERS && chunk + lane < b.samples;
#if ACCESS == ACCESS_NONE
    if (takes) {
      const Prepared t = prepare(source().c.mesh, push.frame, hit.x, corner);
      const float invW = invWOf(t, vec2(pixelOf(hit.y))), depth = depthOf(push.frame, invW);
      if (!isHidden(depth, opaqueDepthAt(push.frame, corner + ivec2(pixelOf(hit.y))))) {
        Fragment f = fragmentAt(corner, hit.y, depth, idOf(t));
        f.source.triangle = t;
        f.source.invW = invW;
        take(owner, f);
      }
    }
#else
    if (takes) {
      const Prepared t = prepare(source().c.mesh, push.frame, hit.x, corner);
      Sample s;
      const float invW = invWOf(t, vec2(pixelOf(hit.y)));
      s.depth = depthOf(push.frame, invW);
      s.id = idOf(t);
      if (shadePrepared(push.frame, t, vec2(pixelOf(hit.y)), invW, s.color)) {
        storeSample(lane, s);
        atomicOr(samplesOf[32u * gl_SubgroupID + hit.y], 1u << lane);
      }
    }
    teamBarrier();
    const uint bit = bitOf(0u);
    uint arrived = lane < OWNERS ? samplesOf[32u * gl_SubgroupID + bit] : 0u;
    if (arrived != 0u) samplesOf[32u * gl_SubgroupID + bit] = 0u;
    for (; arrived != 0u; arrived &= arrived - 1u) {
      const Sample s = loadSample(findLSB(arrived));
      if (isHidden(s.depth, opaque)) continue;
      Fragment f = fragmentAt(corner, bit, s.depth, s.id);
      f.source.isShaded = true;
      f.source.color = s.color;
      take(owner, f);
    }
    teamBarrier();
#endif
  }
}

// Returns how many tri-half-blocks were gone through.
uint deliverList(HalfBlock block) {
  const uint lane = gl_SubgroupInvocationID, team = gl_SubgroupID;
  const ivec2 corner = cornerOf(block.number, push.frame.c.size);
  Owner owners[GROUPS];
  float opaque[GROUPS];
  [[unroll]] for (uint g = 0u; g < GROUPS; ++g) {
    const uint bit = bitOf(g);
    open(owners[g], corner + ivec2(pixelOf(bit)));
    opaque[g] = opaqueDepthAt(push.frame, corner + ivec2(pixelOf(bit)));
    if (lane < OWNERS) samplesOf[32u * team + bit] = 0u;
  }
  uint covered = 0u, iterations = 0u;
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
    TriHalfBlock item = TriHalfBlock(0u, 0u);
    if (first + lane < block.count) {
      uint place = first + lane;
#if DELIVER != DELIVER_ANY
      place = source().c.order.at[block.first + place];
#endif
      item = itemAt(source().c.list, block.first + place);
    }
    covered |= item.mask;
    Batch b = makeBatch(item.triangle, item.mask);
    iterations += min(SUBGROUP_SIZE, block.count - first) - b.size;
    // Where triangles cover many of the pixels, each lane shades its own pixel. Where they are small, lanes take
    // samples one after the other, which costs four times as much per sample. In small subgroups the first way is
    // always faster (lucid/blend.comp).
    if (SMALL_SUBGROUP == 1 || 4u * b.samples >= OWNERS * b.size) {
      for (uint portion = 0u; portion < b.size; portion += PREPARED_COUNT) {
        const uint mine = b.place - b.at - portion;  // wraps around for an earlier portion
        if (item.mask != 0u && mine < PREPARED_COUNT)
          storePrepared(team * PREPARED_COUNT + mine, prepare(source().c.mesh, push.frame, item.triangle, corner));
        teamBarrier();
        const uint here = min(b.size - portion, PREPARED_COUNT);
        iterations += here;
        EACH_GROUP for (uint g = 0u; g < GROUPS; ++g) {
          Owner owner = owners[g];
          deliverBatch(owner, corner, bitOf(g), opaque[g], b.at + portion, here);
          owners[g] = owner;
        }
        teamBarrier();
      }
    } else {
      iterations += b.size;
      teamBarrier();
      deliverSamples(owners[0], b, corner, opaque[0]);
      teamBarrier();  // all lanes have read `batch` before it is written again
    }
  }
  covered = subgroupOr(covered);
  uint taken = 0u;
  EACH_GROUP for (uint g = 0u; g < GROUPS; ++g) {
    Owner owner = owners[g];
    taken += takenBy(owner);
    const uint bit = bitOf(g);
    if (lane < OWNERS && (covered & (1u << bit)) != 0u) close(owner, corner + ivec2(pixelOf(bit)));
  }
  if (source().c.counting != 0u) {
    taken = subgroupAdd(taken);
    if (lane == 0u) atomicAdd(source().c.counters.c.fragments, taken);
  }
  return iterations;
}

// Job i of all lists. Long lists come first, since the frame waits for the last one to end.
HalfBlock blockOf(uint i) {
  const BlockCounters lists = source().c.counters.c.lists;
  if (i < lists.longLists) return source().c.blocks.at[source().c.halfBlocks - 1u - i];
  i -= lists.longLists;
  if (i < lists.mediumLists) return source().c.medium.at[i].block;
  return source().c.blocks.at[i - lists.mediumLists];
}

TEAM_MAIN void main() {
#ifdef PASS_CONDITION
  if (!passRuns()) return;
#endif
  if (source().c.counters.c.lists.overflow != 0u) return;
  const uint group = gl_WorkGroupID.y * source().c.counters.c.lists.allGroups.x + gl_WorkGroupID.x;
  const uint i = subgroupBroadcastFirst(group * TEAMS + gl_SubgroupID);
  if (i >= subgroupBroadcastFirst(source().c.counters.c.lists.allLists)) return;
  const uint iterations = deliverList(uniformly(blockOf(i)));
#if VERIFY_LOOPS
  if (gl_SubgroupInvocationID == 0u) atomicAdd(source().c.counters.c.delivered, iterations);
#endif
}
