#version 460
// Adds up how many fragments an exclusive program took with the hardware source: instrumented frames only, in a stage
// of its own, so that counting is in no time that is reported.
#include "source/state_types.h"

layout(local_size_x = COUNT_TAKEN_GROUP) in;
layout(push_constant, scalar) uniform Push { CountTakenPush push; };

shared uint sum;

void main() {
  if (gl_LocalInvocationIndex == 0u) sum = 0u;
  barrier();
  uint own = 0u;
  for (uint i = gl_GlobalInvocationID.x; i < push.pixels; i += push.invocations) own += push.taken.at[i];
  atomicAdd(sum, own);
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicAdd(push.sum.at[0], sum);
}
