#version 460
// Exact order for pixels whose order was wrong, and for lists that are too long for high raster. The paper proposes
// to register such pixels and to process them with a slower, conservative algorithm (section 2, "Sample blending").
// Here, one subgroup per half-block takes its pixels one after the other, sorts all their fragments and blends them.
#include "common/bindings.glsl"
#include "lucid/lucid_types.h"
#include "raster/blocks/half_block.glsl"

#define TEAMS 1u
#define LIST REPAIR_LIST
layout(local_size_x = SUBGROUP_SIZE) in;
layout(push_constant, scalar) uniform Push { RepairPush push; };

#include "common/order.glsl"
#include "raster/fragments/prepare.glsl"
#include "raster/blocks/exact_sort.glsl"

shared uint found, walked;
shared vec4 colors[SUBGROUP_SIZE];  // alpha negative: the material cuts the fragment out

HalfBlock block;
uint idOfKey(uvec2 key) { return idOfTriangle(push.mesh, push.list.at[block.first + key.y].x); }

// The depth at a pixel, the same bits as in blend.comp.
float depthAt(uint triangle, ivec2 corner, vec2 pixel) {
  const ShadeTriangle s = loadShading(push.mesh, triangle);
  return depthOf(push.frame, boundedInvW(originInvW(s, corner), s, pixel));
}

// Passes a pixel with more fragments than can be sorted here on to deep_capture.comp.
void handOver(uint bit, uint count) {
  const uint deep = atomicAdd(push.counters.c.deepPixels, 1u);
  atomicAdd(push.counters.c.deepNodes, count);
  atomicMax(push.counters.c.deep.y, (block.count + DEEP_CHUNK - 1u) / DEEP_CHUNK);
  if (deep >= push.deepCapacity) return;
  if (deep < MAX_GROUPS) atomicAdd(push.counters.c.deep.x, 1u);
  if (deep % DEEP_RESOLVE_GROUP == 0u) atomicAdd(push.counters.c.deepResolve.x, 1u);
  push.deepPixels.at[deep] = DeepPixel(block, bit, LIST_END, 1u, 0u);
}

void blendPixel(ivec2 corner, uint bit) {
  const uint lane = gl_SubgroupInvocationID;
  const uvec2 pixel = pixelOf(bit);
  const ivec2 place = corner + ivec2(pixel);
  const float opaque = opaqueDepthAt(push.frame, place);
  if (lane == 0u) found = walked = 0u;
  teamBarrier();
  uint steps = 0u;
  for (uint i = lane; i < block.count; i += SUBGROUP_SIZE) {
    ++steps;
    const TriHalfBlock item = itemAt(push.list, block.first + i);
    if ((item.mask & (1u << bit)) == 0u) continue;
    const float depth = depthAt(item.triangle, corner, vec2(pixel));
    if (isHidden(depth, opaque)) continue;
    const uint place = atomicAdd(found, 1u);
    if (place < LIST) keys[place] = uvec2(floatBitsToUint(depth), i);
  }
  atomicAdd(walked, steps);
  teamBarrier();
  const uint count = found;
  if (lane == 0u) {
    atomicAdd(push.counters.c.walked, walked);
    atomicAdd(push.counters.c.expected, block.count);
    atomicAdd(push.counters.c.repairedPixels, 1u);
  }
  if (count > LIST) {  // the same for all lanes
    if (lane == 0u) handOver(bit, count);
    return;
  }
  sortKeys(0u, count);
  vec4 accumulated = vec4(0.0);
  uint samples = 0u;
  for (uint first = 0u; first < count; first += SUBGROUP_SIZE) {
    if (first + lane < count) {
      const TriHalfBlock item = itemAt(push.list, block.first + keys[first + lane].y);
      const Prepared t = prepare(push.mesh, push.frame, item.triangle, corner);
      vec4 color;
      const bool kept = shadePrepared(push.frame, t, vec2(pixel), invWOf(t, vec2(pixel)), color);
      colors[lane] = kept ? color : vec4(-1.0);
    }
    teamBarrier();
    for (uint i = 0u; i < min(SUBGROUP_SIZE, count - first); ++i) {
      if (colors[i].a < 0.0) continue;
      if (push.alphaThreshold > 0.0 && accumulated.a >= push.alphaThreshold) break;
      ++samples;
      accumulated = blendUnder(accumulated, colors[i]);
    }
    teamBarrier();
  }
  if (lane == 0u) {
    imageStore(target, place, overOpaque(accumulated, imageLoad(target, place)));
    if (block.count > HIGH_LIST && (push.flags & COUNT_SAMPLES) != 0u)
      atomicAdd(push.counters.c.samples, samples);  // others were counted by blend.comp
  }
}

TEAM_MAIN void main() {
  const uint jobs = subgroupBroadcastFirst(min(push.counters.c.repairJobs, push.repairCapacity));
  const uint stride = subgroupBroadcastFirst(push.counters.c.repair.x);
  for (uint j = gl_WorkGroupID.x; j < jobs; j += stride) {
    const PixelJob job = push.repairs.at[j];
    block = uniformly(job.block);
    const ivec2 corner = cornerOf(block.number, push.frame.c.size);
    for (uint rest = subgroupBroadcastFirst(job.pixels); rest != 0u; rest &= rest - 1u) {
      blendPixel(corner, findLSB(rest));
      teamBarrier();
    }
  }
}
