#version 460
// Stage 3, phases 2 (sort) and 3 (shading and blending): a subgroup (a "team") a half-block. Low
// raster: LIST = LOW_LIST, several teams a workgroup; high raster: LIST = HIGH_LIST, one.
//
// Each lane owns a pixel: a subgroup of less than 32 lanes goes through the list several times, and of
// one of 64 half the lanes own none.
#include "common/bindings.glsl"
#include "lucid/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { LucidPush push; };

#include "lucid/depth_filter.glsl"
#include "lucid/sort.glsl"

#define OWNERS min(SUBGROUP_SIZE, 32u)

shared uint masks[TEAMS * SUBGROUP_SIZE];      // coverage by the prepared triangles
shared uint ends[TEAMS * SUBGROUP_SIZE];       // running sum of their fragments
shared vec4 sampleColors[TEAMS * OWNERS];
shared uvec2 sampleKeys[TEAMS * OWNERS];       // 1 / w, id
shared uint samplesOf[TEAMS * OWNERS];            // bit i: sample i falls on this pixel

uint nthBit(uint mask, uint n) {
  uint place = 0u;
  [[unroll]] for (uint width = 16u; width > 0u; width /= 2u) {
    const uint below = bitCount(mask & ((1u << width) - 1u));
    const bool above = n >= below;
    n -= above ? below : 0u;
    mask = above ? mask >> width : mask;
    place += above ? width : 0u;
  }
  return place;
}

// A workgroup a job, up to a number that every device can dispatch.
void addJob(HalfBlock block, uint pixels) {
  const uint job = atomicAdd(push.counters.c.repairJobs, 1u);
  if (job < 4096u || job % 64u == 0u) atomicAdd(push.counters.c.repair.x, 1u);
  if (job < push.repairCapacity) push.repairs.at[job] = RepairJob(block, pixels);
}

// Blends those pixels of the half-block that `owned` has, one a lane: the lane's is `bit`. Returns the
// pixels whose order went wrong.
uint sweep(HalfBlock block, ivec2 corner, uint owned, uint bit, bool owner,
           uint placeMask) {
  const uint lane = gl_SubgroupInvocationID, team = gl_SubgroupID;
  const uint firstKey = team * LIST, firstPrepared = team * SUBGROUP_SIZE, firstSample = team * OWNERS;
  const vec2 pixel = vec2(pixelOf(bit));
  const ivec2 place = corner + ivec2(pixel);
  const float opaque = opaqueDepthAt(place);
  Pixel p;
  clearPixel(p);
  if (owner) samplesOf[firstSample + lane] = 0u;

  uint covered = 0u, samples = 0u, turns = 0u;
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
    const uint batch = min(SUBGROUP_SIZE, block.count - first);
    uint mask = 0u;
    if (lane < batch) {
      const uint inList = keys[firstKey + first + lane] & placeMask;
      const TriHalfBlock item = itemAt(push.list, block.first + inList);
      mask = item.mask & owned;
      if (mask != 0u) prepare(firstPrepared + lane, item.triangle, corner);
    }
    const uint end = subgroupInclusiveAdd(bitCount(mask));
    const uint fragments = subgroupAdd(bitCount(mask));
    masks[firstPrepared + lane] = mask;
    ends[firstPrepared + lane] = end;
    covered |= subgroupOr(mask);
    const uint full = push.alphaThreshold > 0.0 ? subgroupOr(owner && isFull(p) ? 1u << bit : 0u) : 0u;
    subgroupBarrier();

    // Where triangles cover most of the pixels, each lane shades its own; where they are small, lanes
    // take samples as they come and hand them to the pixels they fall on.
    if (2u * fragments >= OWNERS * batch) {
      for (uint k = 0u; k < batch; ++k) {
        ++turns;
        const uint at = firstPrepared + k;
        if (!owner || (masks[at] & (1u << bit)) == 0u) continue;
        const float invW = preparedInvW(at, pixel);
        if (isHidden(invW, opaque)) continue;
        Fragment f;
        f.invW = invW;
        f.id = preparedId(at);
        if (!isFull(p) && !shadeFragment(at, pixel, invW, f)) continue;
        pushFragment(p, f);
        ++samples;
      }
    } else {
      turns += batch - (fragments + OWNERS - 1u) / OWNERS;  // so that every batch counts its length
      for (uint chunk = 0u; chunk < fragments; chunk += OWNERS) {
        ++turns;
        const uint n = chunk + lane;
        if (owner && n < fragments) {
          uint k = 0u;  // the first triangle whose samples end beyond n
          [[unroll]] for (uint step = SUBGROUP_SIZE / 2u; step > 0u; step /= 2u)
            if (ends[firstPrepared + k + step - 1u] <= n) k += step;
          const uint at = firstPrepared + k;
          const uint hit = nthBit(masks[at], n - (k == 0u ? 0u : ends[at - 1u]));
          const vec2 hitPixel = vec2(pixelOf(hit));
          Fragment f;
          f.invW = preparedInvW(at, hitPixel);
          f.id = preparedId(at);
          if ((full & (1u << hit)) != 0u || shadeFragment(at, hitPixel, f.invW, f)) {
            sampleColors[firstSample + lane] = f.color;
            sampleKeys[firstSample + lane] = uvec2(floatBitsToUint(f.invW), f.id);
            atomicOr(samplesOf[firstSample + hit % OWNERS], 1u << lane);
          }
        }
        subgroupBarrier();
        uint arrived = owner ? samplesOf[firstSample + lane] : 0u;
        if (arrived != 0u) samplesOf[firstSample + lane] = 0u;
        while (arrived != 0u) {
          const uint i = firstSample + findLSB(arrived);
          arrived &= arrived - 1u;
          const Fragment f = Fragment(uintBitsToFloat(sampleKeys[i].x), sampleKeys[i].y, sampleColors[i]);
          if (isHidden(f.invW, opaque)) continue;
          pushFragment(p, f);
          ++samples;
        }
        subgroupBarrier();
      }
    }
    subgroupBarrier();
  }
  drainPixel(p);

  const uint allSamples = (push.flags & COUNT_SAMPLES) != 0u ? subgroupAdd(samples) : 0u;
  if (lane == 0u) {
    if (allSamples > 0u) atomicAdd(push.counters.c.samples, allSamples);
#if VERIFY_LOOPS
    atomicAdd(push.counters.c.blended, turns);
#endif
  }
  const bool touched = owner && (covered & (1u << bit)) != 0u;
  if (touched) {
    if (p.invalid && (push.flags & (REPAIR | SHOW_ERRORS)) != 0u) {  // repair.comp composes it
      if ((push.flags & SHOW_ERRORS) != 0u) imageStore(target, place, vec4(1.0, 0.0, 0.0, 1.0));
    } else {
      imageStore(target, place, overOpaque(p.accumulated, imageLoad(target, place)));
    }
  }
  return touched && p.invalid ? 1u << bit : 0u;
}

void blendHalfBlock(HalfBlock block) {
  const uint lane = gl_SubgroupInvocationID, firstKey = gl_SubgroupID * LIST;
  const ivec2 corner = cornerOf(block.number, push.frame.c.size);
  // Depths are sorted within their range, so that few bits tell them apart.
  float low = NEAREST, high = 0.0;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE) {
    const float depth = uintBitsToFloat(push.keys.at[block.first + i]);
    low = min(low, depth);
    high = max(high, depth);
  }
  low = subgroupMin(low);
  high = subgroupMax(high);
  const uint bits = findMSB(block.count) + 1;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE)
    keys[firstKey + i] = packKey(uintBitsToFloat(push.keys.at[block.first + i]), low, high, i, bits);
  sortKeys(firstKey, block.count);
  uint invalid = 0u;
  for (uint begin = 0u; begin < 32u; begin += OWNERS) {
    const uint owned = (0xffffffffu >> (32u - OWNERS)) << begin;
    invalid |= sweep(block, corner, owned, min(begin + lane, 31u), lane < OWNERS, (1u << bits) - 1u);
    subgroupBarrier();
  }
  invalid = subgroupOr(invalid);
  if (lane == 0u && invalid != 0u) {
    atomicAdd(push.counters.c.invalidPixels, bitCount(invalid));
    if ((push.flags & REPAIR) != 0u) addJob(block, invalid);
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
    for (uint rest = covered; rest != 0u; rest &= rest - 1u) addJob(block, rest & (0u - rest));
  }
}

void main() {
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint rows = (push.frame.c.size.y + BIN_SIZE - 1u) / BIN_SIZE;
#if HIGH
  const uint count = push.counters.c.longLists;
#else
  const uint count = push.counters.c.shortLists;
#endif
  // One turn a workgroup: which is next is left to the device, where the paper has persistent threads.
  const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  const uint i = group * TEAMS + gl_SubgroupID;
  if (i >= count) return;
#if HIGH
  const HalfBlock block = push.blocks.at[columns * rows * HALF_BLOCKS - 1u - i];
  if (block.count > LIST) handOver(block);
  else blendHalfBlock(block);
#else
  blendHalfBlock(push.blocks.at[i]);
#endif
}
