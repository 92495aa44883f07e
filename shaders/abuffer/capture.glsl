// Section 2: every fragment goes into its pixel's list. COUNTS: it is counted for its pixel too, which the intervals of
// section 3 need. (A stencil that counts is incremented before the cutoff of alpha, and may count too many: see
// find_deep.frag.)
#include "abuffer/abuffer_types.h"
#include "source/fragment.glsl"

void fragment(Fragment f) {
  vec4 color;
  if (!shadeFragment(f, color)) return;
  const uint index = atomicAdd(push.counters.c.fragments, 1u);
  if (index >= push.capacity) return;  // counted all the same: the host grows the pool, or says so
  storeNode(push.nodes, index, color, f.depth, f.id, atomicExchange(push.heads.at[f.index], index));
#ifdef COUNTS
  atomicAdd(push.counts.at[f.index], 1u);
#endif
}
