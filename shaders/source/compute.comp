#version 460
// The compute source: one subgroup (a "team") goes through the list of a half-block, and hands the fragments to a
// fragment program (source/fragment.glsl).
//
// Where a pixel has an owner (ACCESS_BLENDED, ACCESS_EXCLUSIVE), one lane keeps its state in registers. In subgroups of
// fewer than 32 lanes it owns several pixels; in subgroups of 64 lanes half of the lanes own none.
#include "common/bindings.glsl"
#define PREPARED_FLAT 32u  // all triangles of a batch
#include "raster/fragments/bits.glsl"
#include "raster/fragments/prepared.glsl"
#include "raster/fragments/team.glsl"
#include "source/compute_types.h"
#include "source/sample_lanes.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;

struct SourceFragment {
  Prepared triangle;
  vec2 place;  // in the half-block
  float invW;
  bool isShaded;  // by another lane: only the color is known
  vec4 color;
};
#include "source/fragment.glsl"

#include "FRAGMENT_PROGRAM"

#include "source/owners.glsl"

bool shadeFragment(Fragment f, out vec4 color) {
  color = f.source.color;
  if (f.source.isShaded) return true;
  return shadePrepared(push.frame, f.source.triangle, f.source.place, f.source.invW, color);
}

float inverseDistance(Fragment f) {
  return f.source.isShaded ? f.depth / push.frame.c.viewProjection[3][2] : f.source.invW;
}

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

#if DELIVER != DELIVER_ANY
#include "source/order_in_passing.glsl"
#endif

// A lane owns one pixel of each group. Where there are several groups, loops over them are not unrolled.
#define GROUPS (32u / OWNERS)
#if SMALL_SUBGROUP
#define EACH_GROUP [[dont_unroll]]
#else
#define EACH_GROUP [[unroll]]
#endif

// The bit of the lane's pixel of group g in the coverage masks.
uint bitOf(uint g) { return min(gl_SubgroupInvocationID + OWNERS * g, 31u); }

#include "source/deliver_prepared.glsl"

#if SMALL_SUBGROUP == 0
// The samples of small triangles, one per lane. With owners, lanes shade them and hand them to the pixels' owners.
void deliverSamples(inout Owner owner, TriHalfBlock item, uint samples, ivec2 corner, float opaque) {
  const uint lane = gl_SubgroupInvocationID, bit = bitOf(0u);
  Progress progress = beginSamples(item);
  for (uint chunk = 0u; chunk < samples; chunk += OWNERS) {
    const uvec2 hit = nextSample(progress, chunk);
    const bool takes = lane < OWNERS && chunk + lane < samples;
#if ACCESS == ACCESS_NONE
    if (takes)
      deliver(owner, prepare(source().c.mesh, push.frame, hit.x, corner), corner, hit.y,
              opaqueDepthAt(push.frame, corner + ivec2(pixelOf(hit.y))));
#else
    bool exists = false;
    if (takes) {
      const Prepared t = prepare(source().c.mesh, push.frame, hit.x, corner);
      Sample s;
      const float invW = invWOf(t, vec2(pixelOf(hit.y)));
      s.depth = depthOf(push.frame, invW);
      s.id = t.id;
      exists = shadePrepared(push.frame, t, vec2(pixelOf(hit.y)), invW, s.color);
      if (exists) storeSample(lane, s);
    }
    const uint arrivals = lanesAt(exists, hit.y, bit);
    teamBarrier();
    for (uint arrived = lane < OWNERS ? arrivals : 0u; arrived != 0u; arrived &= arrived - 1u) {
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
#endif

// Item `place` of a list, or of its order. Past the end: an empty one.
TriHalfBlock itemOf(HalfBlock block, uint place) {
  if (place >= block.count) return TriHalfBlock(0u, 0u);
#if DELIVER != DELIVER_ANY
  place = source().c.order.at[block.first + place];
#endif
  return itemAt(source().c.list, block.first + place);
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
  }
  uint covered = 0u, iterations = 0u;
#if DELIVER != DELIVER_ANY
  const bool inPassing = block.count <= ORDERED_IN_PASSING(SUBGROUP_SIZE);
  OwnItems own;
  if (inPassing) own = orderInPassing(block);
#endif
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
#if DELIVER == DELIVER_ANY
    const TriHalfBlock item = itemOf(block, first + lane);
#else
    TriHalfBlock item;
    if (inPassing) item = itemInOrder(own, first, block.count);
    else item = itemOf(block, first + lane);
#endif
    covered |= item.mask;
    const uint size = min(SUBGROUP_SIZE, block.count - first);
    iterations += size;
#if SMALL_SUBGROUP == 0
    // Where triangles cover many of the pixels, each lane shades its own pixel. Where they are small, lanes take
    // samples one after the other, which costs four times as much per sample. In small subgroups the first way is
    // always faster (lucid/blend.comp).
    const uint samples = subgroupAdd(bitCount(item.mask));
    if (4u * samples < OWNERS * size) {
      deliverSamples(owners[0], item, samples, corner, opaque[0]);
      continue;
    }
#endif
    for (uint portion = 0u; portion < size; portion += PREPARED_COUNT) {
      const uint here = min(size - portion, PREPARED_COUNT), mine = lane - portion;  // wraps around for an earlier one
      if (mine < here) {
        storePrepared(team * PREPARED_COUNT + mine, prepare(source().c.mesh, push.frame, item.triangle, corner));
        masks[team * PREPARED_COUNT + mine] = item.mask;
      }
      teamBarrier();
      EACH_GROUP for (uint g = 0u; g < GROUPS; ++g) {
        Owner owner = owners[g];
        deliverBatch(owner, corner, bitOf(g), opaque[g], here);
        owners[g] = owner;
      }
      teamBarrier();
    }
  }
  covered = subgroupOr(covered);
  if (lane >= OWNERS) covered = 0u;
  uint taken = 0u;
  EACH_GROUP for (uint g = 0u; g < GROUPS; ++g) {
    Owner owner = owners[g];
    taken += takenBy(owner);
    const uint bit = bitOf(g);
    if ((covered & 1u << bit) != 0u) close(owner, corner + ivec2(pixelOf(bit)));
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
  const HalfBlock block = uniformly(blockOf(i));
#if DELIVER != DELIVER_ANY
  if (block.count > source().c.rule.longest) return;
#endif
  const uint iterations = deliverList(block);
#if VERIFY_LOOPS
  if (gl_SubgroupInvocationID == 0u) atomicAdd(source().c.counters.c.delivered, iterations);
#endif
}
