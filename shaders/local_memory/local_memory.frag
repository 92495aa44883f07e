#version 460
// The shader of figure 3 of Knowles et al. 2013: an array of SIZE vec4 of which one is used, where it
// lies being known only when it runs. The paper reads an array that was never written, which
// compilers are free to do away with; here the one place is written first.
#include "local_memory/local_memory_types.h"

layout(push_constant, scalar) uniform PushBlock { Push push; };
layout(location = 0) out vec4 outColor;

vec4 array[SIZE];

void main() {
  array[push.zero] = vec4(push.zero);
  outColor = array[push.zero * push.zero];
}
