// Blends a pixel's linked list once it is sorted (list_sort.glsl).
#ifndef OITLAB_LIST_BLEND_GLSL
#define OITLAB_LIST_BLEND_GLSL

#include "common/lists.h"
#include "common/order.glsl"

struct BlendedList {
  vec4 accumulated;  // premultiplied
  uint nodes;        // of the list
  uint blended;      // nodes that were blended
};

// Blends the list that begins at `node`, front to back. Nodes of negative alpha are cut out by their material. Behind
// alphaThreshold nothing is blended; 0: there is no threshold. `nodeCount`: nodes that there are. The walk ends after
// as many, also in a list that is not one (lists.h).
BlendedList blendList(NodeBuffer nodes, uint nodeCount, uint node, float alphaThreshold) {
  BlendedList list = BlendedList(vec4(0.0), 0u, 0u);
  for (; node < nodeCount && list.nodes <= nodeCount; node = nodes.at[node].next) {
    ++list.nodes;
    const vec4 color = unpackColor(nodes.at[node].color);
    if (color.a < 0.0 || (alphaThreshold > 0.0 && list.accumulated.a >= alphaThreshold)) continue;
    ++list.blended;
    list.accumulated = blendUnder(list.accumulated, color);
  }
  return list;
}

#endif
