#version 460
// Zeroes several buffers at once.
#include "common/zero_fill.h"

layout(local_size_x = ZERO_FILL_GROUP) in;
layout(push_constant, scalar) uniform Push { ZeroFillPush push; };

void main() {
  [[unroll]] for (uint b = 0u; b < ZERO_FILL_BUFFERS; ++b)
    for (uint i = gl_GlobalInvocationID.x; i < push.words[b]; i += push.invocations)
      push.buffers[b].at[i] = 0u;
}
