#version 460
// Sorts and blends the lists of deep pixels, one invocation per pixel, in as many rounds as needed.
#include "common/bindings.glsl"
#include "common/list_blend.glsl"
#include "common/list_sort.glsl"
#include "lucid/lucid_types.h"
#include "raster/blocks/half_block.glsl"

// Several lists per workgroup: with one list, where everything is uniform, llvmpipe (Mesa 22.3) loses links of it.
layout(local_size_x = DEEP_RESOLVE_GROUP) in;
layout(push_constant, scalar) uniform Push { RepairPush push; };

void main() {
  const uint number = gl_GlobalInvocationID.x;
  if (number >= min(push.counters.c.deepPixels, push.deepCapacity)) return;
  if (push.counters.c.deepCaptured > push.nodeCapacity) return;
  DeepPixel deep = push.deepPixels.at[number];
  if (deep.done != 0u) return;
  const uint most = push.counters.c.deepCaptured;
  if (sortWithinBudget(push.nodes, most, deep.head, deep.run)) {
    const BlendedList list = blendList(push.nodes, most, deep.head, push.alphaThreshold);
    const ivec2 place =
        cornerOf(deep.block.number, push.frame.c.size) + ivec2(pixelOf(deep.bit));
    imageStore(target, place, overOpaque(list.accumulated, imageLoad(target, place)));
    atomicAdd(push.counters.c.deepBlended, list.nodes);
    if (deep.block.count > HIGH_LIST && (push.flags & COUNT_SAMPLES) != 0u)
      atomicAdd(push.counters.c.samples, list.blended);  // others were counted by blend.comp
    deep.done = 1u;
  } else if (push.round + 1u == push.rounds) {
    atomicAdd(push.counters.c.unfinished, 1u);
  }
  push.deepPixels.at[number] = deep;
}
