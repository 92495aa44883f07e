#version 460
// Sorts and blends the lists of deep pixels, one invocation a pixel, over as many rounds as it takes.
#include "common/bindings.glsl"
#include "common/list_sort.glsl"
#include "lucid/half_block.glsl"

layout(local_size_x = 1) in;  // few and long: side by side they would wait for the longest
layout(push_constant, scalar) uniform Push { RepairPush push; };

void main() {
  const uint number = gl_WorkGroupID.x;
  if (push.counters.c.deepCaptured > push.nodeCapacity) return;
  DeepPixel deep = push.deepPixels.at[number];
  if (deep.done != 0u) return;
  if (sortWithinBudget(push.nodes, deep.head, deep.run)) {
    vec4 accumulated = vec4(0.0);
    uint count = 0u;
    for (uint node = deep.head; node != LIST_END; node = push.nodes.at[node].next) {
      ++count;
      if (push.alphaThreshold > 0.0 && accumulated.a >= push.alphaThreshold) continue;
      accumulated = blendUnder(accumulated, push.nodes.at[node].color);
    }
    const ivec2 place =
        cornerOf(deep.block.number, push.frame.c.size) + ivec2(pixelOf(deep.bit));
    imageStore(target, place, overOpaque(accumulated, imageLoad(target, place)));
    atomicAdd(push.counters.c.deepBlended, count);
    deep.done = 1u;
  } else if (push.round + 1u == push.rounds) {
    atomicAdd(push.counters.c.unfinished, 1u);
  }
  push.deepPixels.at[number] = deep;
}
