#version 460
// Stage 3, phases 2 (sort) and 3 (shading and blending): a subgroup (a "team") a half-block. Low
// raster: LIST = LOW_LIST, several teams a workgroup; high raster: LIST = HIGH_LIST, one.
//
// SUBGROUP_SIZE lanes own 32 pixels, 32 / SUBGROUP_SIZE each; of a subgroup of 64 half the lanes own
// none.
#include "common/bindings.glsl"
#include "lucid/half_block.glsl"

layout(local_size_x = TEAMS * SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { LucidPush push; };

#include "common/normal.glsl"
#include "lucid/depth_filter.glsl"
#include "lucid/sort.glsl"

#define OWNERS min(SUBGROUP_SIZE, 32u)
#define PIXELS (32u / OWNERS)

shared uint ends[TEAMS * SUBGROUP_SIZE];       // running sum of the fragments of prepared triangles
shared vec4 sampleColors[TEAMS * OWNERS];
shared uvec2 sampleKeys[TEAMS * OWNERS];       // depth, id
shared uint samplesOf[TEAMS * 32u];            // bit i: sample i falls on this pixel

uint listBegin;
uint idOfKey(uvec2 key) { return push.triangles.at[push.list.at[listBegin + key.y].triangle].id; }

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

void blendHalfBlock(HalfBlock block) {
  const uint lane = gl_SubgroupInvocationID;
  const uint team = gl_SubgroupID;
  const uint firstKey = team * LIST, firstPrepared = team * SUBGROUP_SIZE;
  const ivec2 corner = cornerOf(block.number, push.frame.c.size);
  listBegin = block.first;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE)
    keys[firstKey + i] = uvec2(push.keys.at[block.first + i], i);
  sortKeys(firstKey, block.count);

  Pixel pixels[PIXELS];
  float opaque[PIXELS];
  [[unroll]] for (uint p = 0u; p < PIXELS; ++p) {
    clearPixel(pixels[p]);
    const uint bit = p * OWNERS + lane;
    const ivec2 place = min(corner + ivec2(pixelOf(bit)), ivec2(push.frame.c.size) - 1);
    opaque[p] = texelFetch(opaqueDepth, place, 0).r;
    if (lane < OWNERS) samplesOf[team * 32u + bit] = 0u;
  }

  uint covered = 0u, samples = 0u;
  for (uint first = 0u; first < block.count; first += SUBGROUP_SIZE) {
    const uint batch = min(SUBGROUP_SIZE, block.count - first);
    uint mask = 0u;
    if (lane < batch) {
      const TriHalfBlock item = push.list.at[block.first + keys[firstKey + first + lane].y];
      mask = item.mask;
      prepare(firstPrepared + lane, item, corner);
    }
    const uint end = subgroupInclusiveAdd(bitCount(mask));
    const uint fragments = subgroupAdd(bitCount(mask));
    ends[firstPrepared + lane] = end;
    covered |= subgroupOr(mask);
    subgroupBarrier();

    // Where triangles cover most of the half-block, each lane shades its own pixels; where they are
    // small, lanes take samples as they come and hand them to the pixels they fall on.
    if (2u * fragments >= 32u * batch) {
      for (uint k = 0u; k < batch; ++k) {
        const uint at = firstPrepared + k;
        const uint cover = preparedMask(at);
        [[unroll]] for (uint p = 0u; p < PIXELS; ++p) {
          const uint bit = p * OWNERS + lane;
          if (lane >= OWNERS || (cover & (1u << bit)) == 0u) continue;
          const float invW = preparedInvW(at, vec2(pixelOf(bit)));
          if (depthOf(invW) < opaque[p]) continue;
          Fragment f;
          if (!shadeFragment(at, vec2(pixelOf(bit)), invW, f)) continue;
          pushFragment(pixels[p], f);
          ++samples;
        }
      }
    } else {
      for (uint chunk = 0u; chunk < fragments; chunk += OWNERS) {
        const uint n = chunk + lane;
        if (lane < OWNERS && n < fragments) {
          uint k = 0u;  // the first triangle whose samples end beyond n
          [[unroll]] for (uint step = SUBGROUP_SIZE / 2u; step > 0u; step /= 2u)
            if (ends[firstPrepared + k + step - 1u] <= n) k += step;
          const uint at = firstPrepared + k;
          const uint bit = nthBit(preparedMask(at), n - (k == 0u ? 0u : ends[at - 1u]));
          const float invW = preparedInvW(at, vec2(pixelOf(bit)));
          Fragment f;
          if (shadeFragment(at, vec2(pixelOf(bit)), invW, f)) {
            sampleColors[team * OWNERS + lane] = f.color;
            sampleKeys[team * OWNERS + lane] = uvec2(floatBitsToUint(f.depth), f.id);
            atomicOr(samplesOf[team * 32u + bit], 1u << lane);
          }
        }
        subgroupBarrier();
        [[unroll]] for (uint p = 0u; p < PIXELS; ++p) {
          const uint bit = p * OWNERS + lane;
          uint arrived = lane < OWNERS ? samplesOf[team * 32u + bit] : 0u;
          if (arrived != 0u) samplesOf[team * 32u + bit] = 0u;
          while (arrived != 0u) {
            const uint i = team * OWNERS + findLSB(arrived);
            arrived &= arrived - 1u;
            const Fragment f =
                Fragment(uintBitsToFloat(sampleKeys[i].x), sampleKeys[i].y, sampleColors[i]);
            if (f.depth < opaque[p]) continue;
            pushFragment(pixels[p], f);
            ++samples;
          }
        }
        subgroupBarrier();
      }
    }
    subgroupBarrier();
  }

  uint invalid = 0u;
  [[unroll]] for (uint p = 0u; p < PIXELS; ++p) {
    const uint bit = p * OWNERS + lane;
    drainPixel(pixels[p]);
    if (lane >= OWNERS || (covered & (1u << bit)) == 0u) continue;
    const ivec2 place = corner + ivec2(pixelOf(bit));
    if (pixels[p].invalid) {
      invalid |= 1u << bit;
      if ((push.flags & SHOW_ERRORS) != 0u) {
        imageStore(target, place, vec4(1.0, 0.0, 0.0, 1.0));
        continue;
      }
      if ((push.flags & REPAIR) != 0u) continue;  // repair.comp composes it
    }
    imageStore(target, place, overOpaque(pixels[p].accumulated, imageLoad(target, place)));
  }
  invalid = subgroupOr(invalid);
  const uint allSamples = (push.flags & COUNT_SAMPLES) != 0u ? subgroupAdd(samples) : 0u;
  if (lane != 0u) return;
  if (allSamples > 0u) atomicAdd(push.counters.c.samples, allSamples);
  if (invalid == 0u) return;
  atomicAdd(push.counters.c.invalidPixels, bitCount(invalid));
  if ((push.flags & REPAIR) == 0u) return;
  addJob(block, invalid);
}

// A list that is too long to sort here: each of its pixels is a job of its own for repair.comp,
// which needs no order.
void handOver(HalfBlock block) {
  uint covered = 0u;
  for (uint i = gl_SubgroupInvocationID; i < block.count; i += SUBGROUP_SIZE)
    covered |= push.list.at[block.first + i].mask;
  covered = subgroupOr(covered);
  if (gl_SubgroupInvocationID != 0u) return;
  for (uint rest = covered; rest != 0u; rest &= rest - 1u) addJob(block, rest & (0u - rest));
}

void main() {
  const uint columns = (push.frame.c.size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint rows = (push.frame.c.size.y + BIN_SIZE - 1u) / BIN_SIZE;
#if HIGH
  const uint count = push.counters.c.longLists;
#else
  const uint count = push.counters.c.shortLists;
#endif
  for (uint i = gl_WorkGroupID.x * TEAMS + gl_SubgroupID; i < count; i += gl_NumWorkGroups.x * TEAMS) {
#if HIGH
    const HalfBlock block = push.blocks.at[columns * rows * HALF_BLOCKS - 1u - i];
    if (block.count > LIST) {
      handOver(block);
      continue;
    }
#else
    const HalfBlock block = push.blocks.at[i];
#endif
    blendHalfBlock(block);
    subgroupBarrier();
  }
}
