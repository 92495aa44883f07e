#version 460
// Sorts each pixel's list in place (common/list_sort.glsl), whatever its length, and blends it front
// to back; a pixel that reaches the budget of a round goes on in the next.
#include "common/bindings.glsl"
#include "common/list_blend.glsl"
#include "common/list_sort.glsl"
#include "reference/lists.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ListPush push; };

shared uint groupDeepest;
shared uint groupCovered;
shared uint groupResolved;
shared uint groupUnfinished;

void blendPixel(ivec2 pixel, uint node) {
  const BlendedList list = blendList(push.nodes, push.counters.c.fragments, node, 0.0);
  imageStore(target, pixel, overOpaque(list.accumulated, imageLoad(target, pixel)));
  atomicMax(groupDeepest, list.nodes);
  atomicAdd(groupResolved, list.nodes);
  atomicAdd(groupCovered, 1u);
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupDeepest = 0u;
    groupCovered = 0u;
    groupResolved = 0u;
    groupUnfinished = 0u;
  }
  barrier();

  const uvec2 pixel = gl_GlobalInvocationID.xy;
  // An overflowed capture is recorded again, and its half-built lists are not walked.
  const bool complete = push.counters.c.fragments <= push.capacity;
  if (all(lessThan(pixel, push.frame.c.size)) && complete) {
    const uint index = pixel.y * push.frame.c.size.x + pixel.x;
    uint head = push.heads.at[index];
    if (head != LIST_END) {
      uint run = push.round == 0u ? 1u : push.runs.at[index];
      if (sortWithinBudget(push.nodes, push.counters.c.fragments, head, run)) {
        blendPixel(ivec2(pixel), head);
        head = LIST_END;  // done: later rounds pass it by
      } else {
        push.runs.at[index] = run;
        atomicAdd(groupUnfinished, 1u);
      }
      push.heads.at[index] = head;
    }
  }

  // One global update a workgroup: these counters are for the results, not for the image.
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupCovered + groupUnfinished > 0u) {
    atomicMax(push.counters.c.deepest, groupDeepest);
    atomicAdd(push.counters.c.coveredPixels, groupCovered);
    atomicAdd(push.counters.c.resolved, groupResolved);
    if (push.round + 1u == push.rounds) atomicAdd(push.counters.c.unfinished, groupUnfinished);
  }
}
