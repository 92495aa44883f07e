#version 460
// Stage 3, phase 3 (shading and blending): a subgroup (a "team") a half-block. Three programs:
//   ordered  ORDERED, LIST = ORDERED_LIST: short lists, which are sorted here. Most pixels' fragments come
//            nearly in the order of the sorted triangles, so that a depth filter of 1 will do; pixels in
//            which it does not are passed on,
//   low      these pixels, and half-blocks of longer lists, with the depth filter,
//   high     HIGH, half-blocks of yet longer lists, with the depth filter.
// The latter two find their lists sorted (sort_lists.comp).
//
// Each lane owns a pixel: a subgroup of less than 32 lanes goes through the list several times, and of
// one of 64 half the lanes own none.
#include "common/bindings.glsl"
#include "lucid/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { BlendPush push; };

#include "lucid/depth_filter.glsl"
#include "lucid/prepared.glsl"
#include "lucid/samples.glsl"
#if ORDERED
#include "lucid/sort.glsl"
#endif

shared uint samplesOf[TEAMS * OWNERS];  // bit i: sample i falls on this pixel

// A workgroup a job, up to a number that every device can dispatch; these then take several.
void addRepair(HalfBlock block, uint pixels) {
  const uint job = atomicAdd(push.counters.c.repairJobs, 1u);
  if (job < MAX_GROUPS) atomicAdd(push.counters.c.repair.x, 1u);
  if (job < push.repairCapacity) push.repairs.at[job] = PixelJob(block, pixels);
}

// Long lists by rows: llvmpipe ends loops after 65,535 turns, and a GPU shares the work out better.
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

// To low raster, one workgroup for LOW_TEAMS jobs.
void passOn(HalfBlock block, uint pixels) {
  const uint job = push.counters.c.lowLists + atomicAdd(push.counters.c.passedJobs, 1u);
  push.filterJobs.at[job] = PixelJob(block, pixels);
#if VERIFY_LOOPS
  atomicAdd(push.counters.c.passedOn, block.count * (32u / OWNERS));
#endif
  atomicMax(push.counters.c.low.x, min(job / LOW_TEAMS + 1u, MAX_GROUPS));
}

// The fragment of a prepared triangle at a pixel that it covers or, for nothing, at another.
struct Taken {
  Fragment f;
  bool kept;   // it is there to be pushed
  bool blends; // and not behind the alpha threshold
};

Taken take(uint at, bool covered, vec2 pixel, float opaque, bool full) {
  const Prepared t = loadPrepared(at);
  Taken taken;
  taken.f.invW = invWOf(t, pixel);
  taken.f.id = idOf(t);
  taken.f.color = vec4(0.0);
  taken.kept = covered && !isHidden(taken.f.invW, opaque);
  taken.blends = taken.kept && !full;
#if HAS_TEXTURES  // not for nothing
  if (taken.blends)
#endif
  {
    const bool there = shadePrepared(t, pixel, taken.f.invW, taken.f.color);
    taken.kept = taken.kept && (full || there);
    taken.blends = taken.blends && there;
  }
  return taken;
}

// Of the i-th tri-half-block from the front, in the list.
#if ORDERED
uint placeMask;
uint placeOf(HalfBlock block, uint i) { return keys[gl_SubgroupID * LIST + i] & placeMask; }
#else
uint placeOf(HalfBlock block, uint i) { return push.keys.at[block.first + i]; }
#endif

// Blends those pixels of the half-block that `owned` has, one a lane: the lane's is `bit`. Returns the
// pixels whose order went wrong.
uint sweep(HalfBlock block, ivec2 corner, uint owned, uint bit) {
  const uint lane = gl_SubgroupInvocationID, team = gl_SubgroupID;
  const uint firstSample = team * OWNERS;
  const bool owner = lane < OWNERS && (owned & (1u << bit)) != 0u;
  const vec2 pixel = vec2(pixelOf(bit));
  const ivec2 place = corner + ivec2(pixel);
  const float opaque = opaqueDepthAt(place);
  Pixel p;
  clearPixel(p);
  if (lane < OWNERS) samplesOf[firstSample + lane] = 0u;

  uint covered = 0u, samples = 0u, turns = 0u;
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
    TriHalfBlock item = TriHalfBlock(0u, 0u);
    if (first + lane < block.count) {
      item = itemAt(push.list, block.first + placeOf(block, first + lane));
      item.mask &= owned;
    }
    covered |= item.mask;
    Batch b = makeBatch(item.triangle, item.mask);
    turns += min(SUBGROUP_SIZE, block.count - first) - b.size;
    const uint full = HAS_THRESHOLD == 1 ? subgroupOr(owner && isFull(p) ? 1u << bit : 0u) : 0u;

    // Where triangles cover a good part of the pixels, each lane shades its own; where they are small,
    // lanes take samples as they come and hand them to the pixels they fall on, which costs four times
    // as much a sample.
    if (4u * b.samples >= OWNERS * b.size) {
      for (uint part = 0u; part < b.size; part += PREPARED_COUNT) {
        const uint mine = b.place - b.at - part;  // wraps where it is of an earlier part
        if (item.mask != 0u && mine < PREPARED_COUNT)
          storePrepared(team * PREPARED_COUNT + mine, prepare(item.triangle, corner));
        teamBarrier();
        const uint here = min(b.size - part, PREPARED_COUNT), at = b.at + part;
        turns += here;
        // In pairs, and without branches: what the one waits for, the other has time for. Small
        // subgroups are a CPU's, which has nothing to gain from the one that an odd number lacks.
        const bool inPairs = SUBGROUP_SIZE >= 32u;
        for (uint k = 0u; k < here; k += inPairs ? 2u : 1u) {
          const bool full = isFull(p);
          const bool covers0 = owner && (batch[at + k].y & (1u << bit)) != 0u;
          const Taken t0 = take(team * PREPARED_COUNT + k, covers0, pixel, opaque, full);
          Taken t1;
          if (inPairs) {
            const uint next = min(k + 1u, here - 1u);
            const bool covers1 = owner && (batch[at + next].y & (1u << bit)) != 0u && next > k;
            t1 = take(team * PREPARED_COUNT + next, covers1, pixel, opaque, full);
          }
          if (t0.kept) pushFragment(p, t0.f);
          samples += uint(t0.blends);
          if (inPairs) {
            if (t1.kept) pushFragment(p, t1.f);
            samples += uint(t1.blends);
          }
        }
        teamBarrier();
      }
    } else {
      turns += b.size - (b.samples + OWNERS - 1u) / OWNERS;  // so that every batch counts its length
      teamBarrier();
      for (uint chunk = 0u; chunk < b.samples; chunk += OWNERS) {
        ++turns;
        const uvec2 hit = sampleOf(b, chunk);
        if (lane < OWNERS && chunk + lane < b.samples) {
          const vec2 hitPixel = vec2(pixelOf(hit.y));
          const Prepared t = prepare(hit.x, corner);
          Fragment f;
          f.invW = invWOf(t, hitPixel);
          f.id = idOf(t);
          const bool known = (full & (1u << hit.y)) != 0u;
          if (known || shadePrepared(t, hitPixel, f.invW, f.color)) {
            storeSample(lane, f);
            atomicOr(samplesOf[firstSample + hit.y % OWNERS], 1u << lane);
          }
        }
        teamBarrier();
        uint arrived = owner ? samplesOf[firstSample + lane] : 0u;
        if (arrived != 0u) samplesOf[firstSample + lane] = 0u;
        for (; arrived != 0u; arrived &= arrived - 1u) {
          const Fragment f = loadSample(findLSB(arrived));
          if (!isHidden(f.invW, opaque)) {
            samples += uint(!isFull(p));
            pushFragment(p, f);
          }
        }
        teamBarrier();
      }
    }
  }
  drainPixel(p);
  covered = subgroupOr(covered);
  const bool touched = owner && (covered & (1u << bit)) != 0u;
#if ORDERED
  if (p.invalid) samples = 0u;
#endif
  const uint allSamples = (push.flags & COUNT_SAMPLES) != 0u ? subgroupAdd(samples) : 0u;
  if (lane == 0u) {
    if (allSamples > 0u) atomicAdd(push.counters.c.samples, allSamples);
#if VERIFY_LOOPS
    atomicAdd(push.counters.c.blended, turns);
#endif
  }
  if (touched) {
#if ORDERED
    const bool composes = !p.invalid;
#else
    const bool composes = !p.invalid || (push.flags & (REPAIR | SHOW_ERRORS)) == 0u;
    if (p.invalid && (push.flags & SHOW_ERRORS) != 0u) imageStore(target, place, vec4(1.0, 0.0, 0.0, 1.0));
#endif
    if (composes) imageStore(target, place, overOpaque(p.accumulated, imageLoad(target, place)));
  }
  return touched && p.invalid ? 1u << bit : 0u;
}

void blendHalfBlock(HalfBlock block, uint pixels) {
  const uint lane = gl_SubgroupInvocationID;
  const ivec2 corner = cornerOf(block.number, push.size);
#if ORDERED
  placeMask = sortList(gl_SubgroupID * LIST, block);
#endif
  uint invalid = 0u;
  for (uint begin = 0u; begin < 32u; begin += OWNERS) {
    const uint owned = pixels & (0xffffffffu >> (32u - OWNERS)) << begin;
    if (owned != 0u) {
      invalid |= sweep(block, corner, owned, min(begin + lane, 31u));
#if VERIFY_LOOPS
    } else if (lane == 0u) {
      atomicAdd(push.counters.c.blended, block.count);
#endif
    }
    teamBarrier();
  }
  invalid = subgroupOr(invalid);
#if ORDERED
  if (invalid != 0u) storeOrder(gl_SubgroupID * LIST, block, placeMask);
#endif
  if (lane == 0u && invalid != 0u) {
#if ORDERED
    passOn(block, invalid);
#else
    atomicAdd(push.counters.c.invalidPixels, bitCount(invalid));
    if ((push.flags & REPAIR) != 0u) repair(block, invalid);
#endif
  }
}

// A list that is too long to sort here: each of its pixels is a job of its own for repair.comp,
// which needs no order.
void handOver(HalfBlock block) {
  uint covered = 0u;
  for (uint i = gl_SubgroupInvocationID; i < block.count; i += SUBGROUP_SIZE)
    covered |= push.list.at[block.first + i].y;
  covered = subgroupOr(covered);
  if (gl_SubgroupInvocationID == 0u) {
#if VERIFY_LOOPS
    atomicAdd(push.counters.c.blended, block.count * (32u / OWNERS));
#endif
    atomicAdd(push.counters.c.pixelsToRepair, bitCount(covered));
    for (uint rest = covered; rest != 0u; rest &= rest - 1u) addRepair(block, rest & (0u - rest));
  }
}

TEAM_MAIN void main() {
#if HIGH
  const uint inRow = push.counters.c.high.x;
#elif ORDERED
  const uint inRow = push.counters.c.ordered.x;
#else
  const uint inRow = push.counters.c.low.x;
#endif
  if (push.counters.c.overflow != 0u) return;
  const uint group = gl_WorkGroupID.y * inRow + gl_WorkGroupID.x;
  const uint i = subgroupBroadcastFirst(group * TEAMS + gl_SubgroupID);
#if HIGH
  const uint stride = subgroupBroadcastFirst(inRow) * TEAMS, count = subgroupBroadcastFirst(push.counters.c.highLists);
  for (uint job = i; job < count; job += stride) {
    const HalfBlock block = uniformly(push.blocks.at[push.halfBlocks - 1u - job]);
    if (block.count > HIGH_LIST) handOver(block);
    else blendHalfBlock(block, 0xffffffffu);
    teamBarrier();
  }
#elif ORDERED
  // One turn a workgroup: which is next is left to the device, where the paper has persistent threads.
  if (i < subgroupBroadcastFirst(push.counters.c.orderedLists))
    blendHalfBlock(uniformly(push.blocks.at[i]), 0xffffffffu);
#else
  const uint stride = subgroupBroadcastFirst(inRow) * TEAMS;
  const uint count = subgroupBroadcastFirst(push.counters.c.lowLists + push.counters.c.passedJobs);
  for (uint job = i; job < count; job += stride) {
    const PixelJob pixels = push.filterJobs.at[job];
    blendHalfBlock(uniformly(pixels.block), subgroupBroadcastFirst(pixels.pixels));
    teamBarrier();
  }
#endif
}
