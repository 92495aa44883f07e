#version 460
// Pixels that are too deep for the local arrays, still exact: their lists are sorted where they are
// (common/list_sort.glsl), spread over rounds.
#include "abuffer/finish.glsl"
#include "common/list_blend.glsl"
#include "common/list_sort.glsl"

layout(local_size_x = LIST_GROUP) in;

void main() {
  const uint index = indexInList(gl_WorkGroupID, gl_LocalInvocationIndex);
  if (index >= min(push.counters.c.deepPixels, push.deepCapacity)) return;
  uint run = push.round == 0u ? 1u : push.deep.at[index].run;
  if (run == LIST_END) return;
  const uint pixel = push.deep.at[index].pixel;
  uint head = push.heads.at[pixel];
  const uint most = nodesInLists();
  if (sortWithinBudget(push.nodes, most, head, run)) {
    const BlendedList list = blendList(push.nodes, most, head, 0.0);
    if (head == LIST_END) atomicAdd(push.counters.c.broken, 1u);
    else finishPixel(pixel, head, list.accumulated, Tally(list.nodes, 0u));
    run = LIST_END;
  } else if (push.round + 1u == push.rounds) {
    atomicAdd(push.counters.c.unfinished, 1u);
  }
  push.heads.at[pixel] = head;
  push.deep.at[index].run = run;
}
