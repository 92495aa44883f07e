// What a sort moves: an entry for each fragment in the local array.
//
// Eight bytes, the depth and the node; the colour (and the id, for equal depths) stay in the node.
// With LOCAL_COLOR the colour comes along as it is stored, as in the paper, whose arrays hold 16
// bytes a fragment: that is half-float colours here.
#ifndef OITLAB_ABUFFER_ENTRY_GLSL
#define OITLAB_ABUFFER_ENTRY_GLSL

#include "abuffer/abuffer_types.h"
#include "common/order.glsl"

struct Entry {
  float depth;
  uint node;
#ifdef LOCAL_COLOR
  NODE_COLOR_TYPE color;
#endif
};

Entry entryOf(uint node) {
  Entry entry;
  entry.depth = push.nodes.at[node].depth;
  entry.node = node;
#ifdef LOCAL_COLOR
  entry.color = push.nodes.at[node].color;
#endif
  return entry;
}

// Behind every fragment (depths are 0 and above), for sorts that want a round number of entries.
Entry noEntry() {
  Entry entry;
  entry.depth = -1.0;
  entry.node = LIST_END;
  return entry;
}

// HELPERS: the shader has helper invocations. llvmpipe (Mesa 25.0.7) ends a loop when only helper invocations are
// left in it. A helper's array may then hold entries that were never loaded.
uint nodeOf(Entry entry) {
#ifdef HELPERS
  return min(entry.node, push.capacity - 1u);
#else
  return entry.node;
#endif
}

vec4 colorOf(Entry entry) {
#ifdef LOCAL_COLOR
  return unpackColor(entry.color);
#else
  return unpackColor(push.nodes.at[nodeOf(entry)].color);
#endif
}

// The order of isInFront(); ids are fetched only for equal depths, which are rare.
bool isInFront(Entry a, Entry b) {
  if (a.depth != b.depth || a.depth < 0.0) return a.depth > b.depth;
  return isInFront(a.depth, push.nodes.at[nodeOf(a)].id, b.depth, push.nodes.at[nodeOf(b)].id);
}

#endif
