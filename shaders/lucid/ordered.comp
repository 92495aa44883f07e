#version 460
// Stage 3, phases 2 and 3, for half-blocks of few triangles that do not overlap in depth: there the
// order of triangles is the order of fragments, and no depth filter is needed. A subgroup (a "team") a
// half-block. Others go on to blend.comp.
#include "common/bindings.glsl"
#include "lucid/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { BlendPush push; };

#define PREPARED_COUNT (TEAMS * SHORT_LIST)
#include "common/order.glsl"
#include "lucid/prepared.glsl"
#include "lucid/samples.glsl"

#define SWEEPS (32u / OWNERS)  // of a short subgroup over the pixels

shared uvec4 ranges[TEAMS * SHORT_LIST];  // farthest and nearest 1 / w, mask, slot
shared uvec2 sorted[TEAMS * SHORT_LIST];  // slot, mask
shared vec4 colors[TEAMS * OWNERS];
shared uint samplesOf[TEAMS * 32];        // of a pixel: bit i: sample i falls on it

// 1 / w over the mask's bounds: since rounding keeps order, it is farthest and nearest in corners,
// to the last bit.
vec2 rangeOf(ShadeTriangle s, ivec2 corner, uint mask) {
  const uint columns = (mask | mask >> 8 | mask >> 16 | mask >> 24) & 0xffu;
  const vec2 low = vec2(findLSB(columns), findLSB(mask) / 8);
  const vec2 high = vec2(findMSB(columns), findMSB(mask) / 8);
  const float origin = originInvW(s, corner);
  const vec4 at = vec4(boundedInvW(origin, s, low), boundedInvW(origin, s, vec2(high.x, low.y)),
                       boundedInvW(origin, s, vec2(low.x, high.y)), boundedInvW(origin, s, high));
  return vec2(min(min(at.x, at.y), min(at.z, at.w)), max(max(at.x, at.y), max(at.z, at.w)));
}

// Sorts the triangles front to back into `sorted`. False where two that share a pixel overlap in depth.
bool sortTriangles(HalfBlock block, ivec2 corner, uint base) {
  const uint lane = gl_SubgroupInvocationID;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE) {
    const TriHalfBlock item = itemAt(push.list, block.first + i);
    const vec2 range = rangeOf(loadShading(push.shading, item.triangle), corner, item.mask);
    ranges[base + i] = uvec4(floatBitsToUint(range), item.mask, item.triangle);
  }
  teamBarrier();
  bool overlaps = false;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE) {
    const uvec4 own = ranges[base + i];
    uint rank = 0u;
    for (uint k = 0u; k < block.count; ++k) {
      const uvec4 other = ranges[base + k];
      const bool before = other.y > own.y || (other.y == own.y && k < i);
      rank += uint(before);
      const bool apart = before ? other.x > own.y : own.x > other.y;
      overlaps = overlaps || ((other.z & own.z) != 0u && !apart && k != i);
    }
    sorted[base + rank] = uvec2(own.w, own.z);
  }
  teamBarrier();
  return !subgroupAny(overlaps);
}

// Half-blocks for blend.comp. As many workgroups as it takes, up to a number that every device can
// dispatch.
void passOn(HalfBlock block) {
  const uint place = atomicAdd(push.counters.c.lowLists, 1u);
  push.blocks.at[push.halfBlocks + place] = block;
  if (place % LOW_TEAMS == 0u && place < MAX_GROUPS * LOW_TEAMS) atomicAdd(push.counters.c.low.x, 1u);
}

void compose(ivec2 place, vec4 accumulated) {
  imageStore(target, place, overOpaque(accumulated, imageLoad(target, place)));
}

bool isFull(vec4 accumulated) {
  return push.alphaThreshold > 0.0 && accumulated.a >= push.alphaThreshold;
}

// Where triangles cover most of the pixels, each lane shades its own pixel. Returns the lane's samples.
uint blendByPixel(HalfBlock block, ivec2 corner, uint base, uint covered) {
  const uint lane = gl_SubgroupInvocationID;
  uint samples = 0u;
  for (uint k = lane; k < block.count; k += SUBGROUP_SIZE)
    storePrepared(base + k, prepare(sorted[base + k].x, corner));
  teamBarrier();
  for (uint begin = 0u; begin < 32u; begin += OWNERS) {
    const uint bit = min(begin + lane, 31u);
    const vec2 pixel = vec2(pixelOf(bit));
    const ivec2 place = corner + ivec2(pixel);
    const float opaque = opaqueDepthAt(place);
    const bool owner = lane < OWNERS;
    vec4 accumulated = vec4(0.0);
    for (uint k = 0u; k < block.count; ++k) {
      if (!owner || (sorted[base + k].y & (1u << bit)) == 0u) continue;
      const Prepared p = loadPrepared(base + k);
      const float invW = invWOf(p, pixel);
      if (isFull(accumulated) || isHidden(invW, opaque)) continue;
      vec4 color;
      if (!shadePrepared(p, pixel, invW, color)) continue;
      accumulated = blendUnder(accumulated, color);
      ++samples;
    }
    if (owner && (covered & (1u << bit)) != 0u) compose(place, accumulated);
  }
  return samples;
}

// Where triangles are small, lanes take samples as they come.
uint blendBySample(HalfBlock block, ivec2 corner, uint base, uint covered) {
  const uint lane = gl_SubgroupInvocationID, team = gl_SubgroupID;
  const bool owner = lane < OWNERS;
  vec4 accumulated[SWEEPS];
  uint samples = 0u;
  [[unroll]] for (uint s = 0u; s < SWEEPS; ++s) {
    accumulated[s] = vec4(0.0);
    if (owner) samplesOf[team * 32u + s * OWNERS + lane] = 0u;
  }
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
    const uvec2 own = first + lane < block.count ? sorted[base + first + lane] : uvec2(0u);
    Batch b = makeBatch(own.x, own.y);
    for (uint chunk = 0u; chunk < b.samples; chunk += OWNERS) {
      const uvec2 hit = sampleOf(b, chunk);
      if (owner && chunk + lane < b.samples) {
        const vec2 pixel = vec2(pixelOf(hit.y));
        const Prepared p = prepare(hit.x, corner);
        const float invW = invWOf(p, pixel);
        vec4 color;
        if (!isHidden(invW, opaqueDepthAt(corner + ivec2(pixel))) &&
            shadePrepared(p, pixel, invW, color)) {
          colors[team * OWNERS + lane] = color;
          atomicOr(samplesOf[team * 32u + hit.y], 1u << lane);
        }
      }
      teamBarrier();
      if (owner) {
        [[unroll]] for (uint s = 0u; s < SWEEPS; ++s) {
          const uint place = team * 32u + s * OWNERS + lane;
          uint arrived = samplesOf[place];
          if (arrived != 0u) samplesOf[place] = 0u;
          for (; arrived != 0u; arrived &= arrived - 1u) {
            if (isFull(accumulated[s])) break;
            accumulated[s] =
                blendUnder(accumulated[s], colors[team * OWNERS + findLSB(arrived)]);
            ++samples;
          }
        }
      }
      teamBarrier();
    }
  }
  [[unroll]] for (uint s = 0u; s < SWEEPS; ++s) {
    const uint bit = min(s * OWNERS + lane, 31u);
    if (owner && (covered & (1u << bit)) != 0u)
      compose(corner + ivec2(pixelOf(bit)), accumulated[s]);
  }
  return samples;
}

void main() {
  // One turn a workgroup: which is next is left to the device, where the paper has persistent threads.
  const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  const uint i = group * TEAMS + gl_SubgroupID;
  if (i >= push.counters.c.shortLists) return;
  const HalfBlock block = push.blocks.at[i];
  const uint lane = gl_SubgroupInvocationID, base = gl_SubgroupID * SHORT_LIST;
  const ivec2 corner = cornerOf(block.number, push.size);
  if (!sortTriangles(block, corner, base)) {
    if (lane == 0u) passOn(block);
    return;
  }
  uint covered = 0u, fragments = 0u;
  for (uint k = lane; k < block.count; k += SUBGROUP_SIZE) {
    covered |= sorted[base + k].y;
    fragments += bitCount(sorted[base + k].y);
  }
  covered = subgroupOr(covered);
  fragments = subgroupAdd(fragments);
  const bool byPixel = 2u * fragments >= 32u * block.count;
  const uint samples = byPixel ? blendByPixel(block, corner, base, covered)
                               : blendBySample(block, corner, base, covered);
  const uint all = (push.flags & COUNT_SAMPLES) != 0u ? subgroupAdd(samples) : 0u;
  if (lane != 0u) return;
  if (all > 0u) atomicAdd(push.counters.c.samples, all);
#if VERIFY_LOOPS
  atomicAdd(push.counters.c.blended, block.count * SWEEPS);
#endif
}
