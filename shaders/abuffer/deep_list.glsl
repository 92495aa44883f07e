// The list of pixels that are too deep for the local arrays; deep.comp goes through it.
#ifndef OITLAB_ABUFFER_DEEP_LIST_GLSL
#define OITLAB_ABUFFER_DEEP_LIST_GLSL

#include "abuffer/abuffer_types.h"

void appendDeep(uint pixel) {
  const uint index = atomicAdd(push.counters.c.deepPixels, 1u);
  if (index >= push.deepCapacity) return;  // counted all the same: the host grows the list
  push.deep.at[index].pixel = pixel;
  const uint groups = index / LIST_GROUP + 1u;
  atomicMax(push.counters.c.deepGroups.x, min(groups, LIST_GROUPS_X));
  atomicMax(push.counters.c.deepGroups.y, (groups + LIST_GROUPS_X - 1u) / LIST_GROUPS_X);
}

#endif
