#version 460
// From the number of pixels of each interval: the arguments of its indirect draws and dispatch, and
// where in the lists its pixels go.
#include "abuffer/abuffer_types.h"

layout(local_size_x = 1) in;

void main() {
  uint begin = 0u;
  for (uint i = 0u; i < push.intervalCount; ++i) {
    const uint pixels = push.intervals.at[i].pixels;
    push.intervals.at[i].vertexCount = 3u;
    push.intervals.at[i].instanceCount = min(pixels, 1u);
    const uint groups = (pixels + LIST_GROUP - 1u) / LIST_GROUP;
    push.intervals.at[i].groups.x = min(groups, LIST_GROUPS_X);
    push.intervals.at[i].groups.y = (groups + LIST_GROUPS_X - 1u) / LIST_GROUPS_X;
    push.intervals.at[i].groups.z = 1u;
    push.intervals.at[i].begin = begin;
    push.intervals.at[i].cursor = begin;
    begin += pixels;
  }
}
