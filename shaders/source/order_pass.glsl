// What the passes that order lists share. Keys are pairs: what to order by, and the place in the list. The includer
// declares `push` as OrderPush, and sets `block`.
#ifndef OITLAB_SOURCE_ORDER_PASS_GLSL
#define OITLAB_SOURCE_ORDER_PASS_GLSL

#include "source/order.glsl"

HalfBlock block;

// Of one of several tri-half-blocks of equal depth.
uint idOfKey(uvec2 key) { return idOfTriangle(push.mesh, push.list.at[block.first + key.y].x); }

#endif
