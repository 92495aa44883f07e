#version 460
// The key of a triangle: farther centroids have smaller keys, so that an ascending sort puts them first.
#include "blend/sort_types.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { CentroidPush push; };

vec3 corner(uint index) { return push.frame.c.vertices.at[push.submitted.at[index]].position; }

void main() {
  for (uint i = 0u; i < SORT_ITEMS; ++i) {
    const uint place = gl_WorkGroupID.x * SORT_BLOCK + i * SORT_GROUP + gl_LocalInvocationIndex;
    if (place >= push.count) return;
    const uint first = 3u * place;
    const vec3 middle = (corner(first) + corner(first + 1u) + corner(first + 2u)) / 3.0;
    const vec3 offset = middle - push.eye;
    // The bits of floats that are not negative are ordered as the floats are.
    push.keys.at[place] = ~floatBitsToUint(dot(offset, offset));
    push.values.at[place] = place;
  }
}
