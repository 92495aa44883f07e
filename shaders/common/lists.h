// Per-pixel linked lists of fragments (Yang et al. 2010; Knowles et al. 2013, section 2), for every
// method that keeps them. C++ and GLSL both include this.
//
// NODE_COLOR says how a node holds its colour: 0 four floats (the default: exact), 1 four halves,
// 2 four 8-bit numbers.
#ifndef OITLAB_LISTS_H
#define OITLAB_LISTS_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab {
#endif

// An index that no node has. Where a walk would do harm in a list that is not one (it has a cycle, or
// something else has been written over it), it ends at any index that no node has, and after as many
// nodes as there are.
#define LIST_END 0xffffffffu

#ifndef NODE_COLOR
#define NODE_COLOR 0
#endif
#if NODE_COLOR == 1
#define NODE_COLOR_TYPE uvec2
#elif NODE_COLOR == 2
#define NODE_COLOR_TYPE uint
#else
#define NODE_COLOR_TYPE vec4
#endif

// 28 bytes a fragment with full float colour.
struct Node {
  NODE_COLOR_TYPE color;  // straight, linear
  float depth;
  uint id;    // primitive id
  uint next;  // index of a node, or LIST_END
};

#ifdef __cplusplus
}  // namespace oitlab
#else
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer NodeBuffer { Node at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HeadBuffer { uint at[]; };

#if NODE_COLOR == 1
NODE_COLOR_TYPE packColor(vec4 color) {
  return uvec2(packHalf2x16(color.rg), packHalf2x16(color.ba));
}
vec4 unpackColor(NODE_COLOR_TYPE packed) {
  return vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
}
#elif NODE_COLOR == 2
NODE_COLOR_TYPE packColor(vec4 color) { return packUnorm4x8(color); }
vec4 unpackColor(NODE_COLOR_TYPE packed) { return unpackUnorm4x8(packed); }
#else
NODE_COLOR_TYPE packColor(vec4 color) { return color; }
vec4 unpackColor(NODE_COLOR_TYPE packed) { return packed; }
#endif

// Stores a fragment in node `index`, which is the caller's own, before the node `next`. A fragment joins a list with
// next = atomicExchange(head of the list, index).
void storeNode(NodeBuffer nodes, uint index, vec4 color, float depth, uint id, uint next) {
  nodes.at[index] = Node(packColor(color), depth, id, next);
}
#endif

#endif
