#version 460
// Stage 3, phase 3 (shading and blending): one subgroup (a "team") per half-block. Three programs:
//   ordered  ORDERED, LIST = SHORT_LIST: short lists, which are sorted here. In most pixels the fragments arrive
//            nearly in the order of the sorted triangles, so that a depth filter of 1 is enough. The other pixels
//            are passed on to low.
//   low      these pixels, and half-blocks with longer lists, with the depth filter.
//   high     HIGH: half-blocks with even longer lists, with the depth filter.
// Low and high read lists that sort_lists.comp has sorted.
//
// Each lane owns one pixel. In subgroups of fewer than 32 lanes it owns several; in subgroups of 64 lanes half of
// the lanes own none.
#include "common/bindings.glsl"
#include "lucid/lucid_types.h"
#include "raster/blocks/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { BlendPush push; };

#include "lucid/pixels.glsl"
#if ORDERED
#include "lucid/short_list.glsl"
#else
// Place in the list of the i-th tri-half-block from the front.
uint placeOf(HalfBlock block, uint i) { return push.keys.at[block.first + i]; }
#endif

// One workgroup per job, up to the number that every device can dispatch. Beyond that, workgroups take several jobs.
void addRepair(HalfBlock block, uint pixels) {
  const uint job = atomicAdd(push.counters.c.repairJobs, 1u);
  if (job < MAX_GROUPS) atomicAdd(push.counters.c.repair.x, 1u);
  if (job < push.repairCapacity) push.repairs.at[job] = PixelJob(block, pixels);
}

// Long lists are repaired row by row: llvmpipe ends loops after 65,535 iterations, and GPUs balance the work better.
void repair(HalfBlock block, uint pixels) {
  atomicAdd(push.counters.c.pixelsToRepair, bitCount(pixels));
  if (block.count <= ROW_REPAIR) {
    addRepair(block, pixels);
    return;
  }
  for (uint row = 0u; row < HALF_BLOCK_HEIGHT; ++row) {
    const uint inRow = pixels & (0xffu << (HALF_BLOCK_WIDTH * row));
    if (inRow != 0u) addRepair(block, inRow);
  }
}

// Passes pixels on to low raster, which has one workgroup per MEDIUM_TEAMS jobs.
void passOn(HalfBlock block, uint pixels) {
  const uint job = push.counters.c.lists.mediumLists + atomicAdd(push.counters.c.passedJobs, 1u);
  push.medium.at[job] = PixelJob(block, pixels);
#if VERIFY_LOOPS
  atomicAdd(push.counters.c.passedOn, block.count);
#endif
  atomicMax(push.counters.c.lists.mediumGroups.x, min(job / MEDIUM_TEAMS + 1u, MAX_GROUPS));
}

void countSamples(uint samples, uint iterations) {
  const uint all = (push.flags & COUNT_SAMPLES) != 0u ? subgroupAdd(samples) : 0u;
  if (gl_SubgroupInvocationID != 0u) return;
  if (all > 0u) atomicAdd(push.counters.c.samples, all);
#if VERIFY_LOOPS
  atomicAdd(push.counters.c.blended, iterations);
#endif
}

// Blends the pixels of the half-block that are set in `owned`. Returns the lane's pixels whose order was wrong.
uint sweep(HalfBlock block, ivec2 corner, uint owned) {
  const uint lane = gl_SubgroupInvocationID, team = gl_SubgroupID;
  const uint own = lane < OWNERS ? owned : 0u;
  Pixel pixels[GROUPS];
  float opaque[GROUPS];
  [[unroll]] for (uint g = 0u; g < GROUPS; ++g) {
    const uint bit = bitOf(g);
    clearPixel(pixels[g]);
    opaque[g] = opaqueDepthAt(push.frame, corner + ivec2(pixelOf(bit)));
    if (lane < OWNERS) samplesOf[32u * team + bit] = 0u;
  }

  uint covered = 0u, iterations = 0u;
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
    TriHalfBlock item = TriHalfBlock(0u, 0u);
    if (first + lane < block.count) {
      item = itemAt(push.list, block.first + placeOf(block, first + lane));
      item.mask &= owned;
    }
    covered |= item.mask;
    Batch b = makeBatch(item.triangle, item.mask);
    iterations += min(SUBGROUP_SIZE, block.count - first) - b.size;

    // Where triangles cover many of the pixels, each lane shades its own pixel. Where they are small, lanes take
    // samples one after the other and hand them to the pixels that they fall on, which costs four times as much
    // per sample. In small subgroups, where a prepared triangle serves several pixels per lane, the first way is
    // always faster, and llvmpipe executes both sides of a branch even if no lane takes one of them.
    if (SMALL_SUBGROUP == 1 || 4u * b.samples >= OWNERS * b.size) {
#if INTERPOLATES == 0
      // Prepared once for all portions. With interpolation this would take more registers than it saves time.
      Prepared ready;
      if (item.mask != 0u) ready = prepare(push.mesh, push.frame, item.triangle, corner);
#endif
      for (uint portion = 0u; portion < b.size; portion += PREPARED_COUNT) {
        const uint mine = b.place - b.at - portion;  // wraps around for an earlier portion
        if (item.mask != 0u && mine < PREPARED_COUNT) {
#if INTERPOLATES
          const Prepared ready = prepare(push.mesh, push.frame, item.triangle, corner);
#endif
          storePrepared(team * PREPARED_COUNT + mine, ready);
        }
        teamBarrier();
        const uint here = min(b.size - portion, PREPARED_COUNT);
        iterations += here;
        EACH_GROUP for (uint g = 0u; g < GROUPS; ++g) {
          Pixel p = pixels[g];
          blendPrepared(p, own, bitOf(g), opaque[g], b.at + portion, here);
          pixels[g] = p;
        }
        teamBarrier();
      }
    } else {
      const uint full = HAS_THRESHOLD == 1 ? subgroupOr(isFull(pixels[0]) ? own & 1u << bitOf(0u) : 0u) : 0u;
      iterations += b.size - (b.samples + OWNERS - 1u) / OWNERS;  // so that each batch counts its full length
      teamBarrier();
      for (uint chunk = 0u; chunk < b.samples; chunk += OWNERS) {
        ++iterations;
        const uvec2 hit = sampleOf(b, chunk);
        if (lane < OWNERS && chunk + lane < b.samples) {
          const vec2 hitPixel = vec2(pixelOf(hit.y));
          const Prepared t = prepare(push.mesh, push.frame, hit.x, corner);
          Sample f;
          const float invW = invWOf(t, hitPixel);
          f.depth = depthOf(push.frame, invW);
          f.id = t.id;
          const bool known = (full & (1u << hit.y)) != 0u;
          if (known || shadePrepared(push.frame, t, hitPixel, invW, f.color)) {
            storeSample(lane, f);
            atomicOr(samplesOf[32u * team + hit.y], 1u << lane);
          }
        }
        teamBarrier();
        blendSamples(pixels[0], own, bitOf(0u), opaque[0]);
        teamBarrier();
      }
    }
  }
  covered = subgroupOr(covered);
  uint invalid = 0u, samples = 0u;
  EACH_GROUP for (uint g = 0u; g < GROUPS; ++g) {
    Pixel p = pixels[g];
    drainPixel(p);
    const uint bit = bitOf(g);
    if ((covered & own & (1u << bit)) == 0u) continue;
    const ivec2 place = corner + ivec2(pixelOf(bit));
    if (p.invalid) invalid |= 1u << bit;
#if ORDERED
    const bool composes = !p.invalid;
    samples += composes ? p.samples : 0u;
#else
    samples += p.samples;
    const bool composes = !p.invalid || (push.flags & (REPAIR | SHOW_ERRORS)) == 0u;
    if (p.invalid && (push.flags & SHOW_ERRORS) != 0u) imageStore(target, place, vec4(1.0, 0.0, 0.0, 1.0));
#endif
    if (composes) imageStore(target, place, overOpaque(p.accumulated, imageLoad(target, place)));
  }
  countSamples(samples, iterations);
  return invalid;
}

void blendHalfBlock(HalfBlock block, uint pixels) {
#if ORDERED
  orderList(block);
#endif
  const uint invalid = subgroupOr(sweep(block, cornerOf(block.number, push.size), pixels));
  teamBarrier();
#if ORDERED
  if (invalid != 0u) storeOrder(block);
#endif
  if (gl_SubgroupInvocationID == 0u && invalid != 0u) {
#if ORDERED
    passOn(block, invalid);
#else
    atomicAdd(push.counters.c.invalidPixels, bitCount(invalid));
    if ((push.flags & REPAIR) != 0u) repair(block, invalid);
#endif
  }
}

// For a list that is too long to be sorted: each of its pixels becomes a job for repair.comp, which needs no order.
void handOver(HalfBlock block) {
  uint covered = 0u;
  for (uint i = gl_SubgroupInvocationID; i < block.count; i += SUBGROUP_SIZE)
    covered |= push.list.at[block.first + i].y;
  covered = subgroupOr(covered);
  if (gl_SubgroupInvocationID == 0u) {
#if VERIFY_LOOPS
    atomicAdd(push.counters.c.blended, block.count);
#endif
    atomicAdd(push.counters.c.pixelsToRepair, bitCount(covered));
    for (uint rest = covered; rest != 0u; rest &= rest - 1u) addRepair(block, rest & (0u - rest));
  }
}

// The sizes of later dispatches that do not depend on what is counted. Each program of this step may be the only one.
void shapeDispatches() {
  if (gl_WorkGroupID.x + gl_WorkGroupID.y + gl_LocalInvocationIndex != 0u) return;
  atomicMax(push.counters.c.repair.y, 1u);
  atomicMax(push.counters.c.repair.z, 1u);
  atomicMax(push.counters.c.deep.z, 1u);
  atomicMax(push.counters.c.deepResolve.y, 1u);
  atomicMax(push.counters.c.deepResolve.z, 1u);
}

TEAM_MAIN void main() {
  shapeDispatches();
#if HIGH
  const uint inRow = push.counters.c.lists.longGroups.x;
#elif ORDERED
  const uint inRow = push.counters.c.lists.shortGroups.x;
#else
  const uint inRow = push.counters.c.lists.mediumGroups.x;
#endif
  if (push.counters.c.lists.overflow != 0u) return;
  const uint group = gl_WorkGroupID.y * inRow + gl_WorkGroupID.x;
  const uint i = subgroupBroadcastFirst(group * TEAMS + gl_SubgroupID);
#if HIGH
  const uint stride = subgroupBroadcastFirst(inRow) * TEAMS;
  const uint count = subgroupBroadcastFirst(push.counters.c.lists.longLists);
  for (uint job = i; job < count; job += stride) {
    const HalfBlock block = uniformly(push.blocks.at[push.halfBlocks - 1u - job]);
    if (block.count > HIGH_LIST) handOver(block);
    else blendHalfBlock(block, 0xffffffffu);
    teamBarrier();
  }
#elif ORDERED
  // One half-block per team. The device schedules the workgroups, where the paper has persistent threads.
  if (i < subgroupBroadcastFirst(push.counters.c.lists.shortLists))
    blendHalfBlock(uniformly(push.blocks.at[i]), 0xffffffffu);
#else
  const uint stride = subgroupBroadcastFirst(inRow) * TEAMS;
  const uint count = subgroupBroadcastFirst(push.counters.c.lists.mediumLists + push.counters.c.passedJobs);
  for (uint job = i; job < count; job += stride) {
    const PixelJob pixels = push.medium.at[job];
    blendHalfBlock(uniformly(pixels.block), subgroupBroadcastFirst(pixels.pixels));
    teamBarrier();
  }
#endif
}
