#version 460
// The index buffer in sorted order, and the place in it of each triangle.
#include "blend/sort_types.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { CentroidPush push; };

void main() {
  for (uint i = 0u; i < SORT_ITEMS; ++i) {
    const uint place = gl_WorkGroupID.x * SORT_BLOCK + i * SORT_GROUP + gl_LocalInvocationIndex;
    if (place >= push.count) return;
    const uint from = push.values.at[place];
    if (uint64_t(push.sequence) != 0ul) push.sequence.at[push.frame.c.transparentIds.at[from]] = place;
    for (uint corner = 0u; corner < 3u; ++corner)
      push.sorted.at[3u * place + corner] = push.submitted.at[3u * from + corner];
  }
}
