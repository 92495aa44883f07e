// Captures every fragment into its pixel's list.
#include "reference/lists.h"
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform Push { ListPush push; };

void fragment(Fragment f) {
  vec4 color;
  if (!shadeFragment(f, color)) return;
  const uint index = atomicAdd(push.counters.c.fragments, 1u);
  if (index >= push.capacity) return;  // counted all the same: the host grows the pool
  storeNode(push.nodes, index, color, f.depth, f.id, atomicExchange(push.heads.at[f.index], index));
}
