#version 460
// A fixed amount of arithmetic that touches no memory: how long it takes says how high the clock is.
#include "measure/clock_probe_types.h"

layout(local_size_x = CLOCK_PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push { ClockProbePush push; };

void main() {
  float x = float(gl_LocalInvocationIndex) / float(CLOCK_PROBE_GROUP);
  for (uint iteration = 0u; iteration < push.iterations; ++iteration)
    [[unroll]] for (uint i = 0u; i < CLOCK_PROBE_UNROLL; ++i) x = fma(x, push.factor, push.summand);
  // Never so, which the compiler cannot know: it has to compute x, and nothing waits for memory.
  if (x > push.threshold) push.result.value = x;
}
