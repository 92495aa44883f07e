// Multi-layer alpha blending (Salvi and Vaidyanathan 2014): a pixel has NODES nodes, sorted by depth, each of which is
// one or more fragments blended. Where a fragment more comes, two neighbors are merged.
#include "common/order.glsl"
#include "mlab/node_color.glsl"
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform PushBlock { FrameBuffer frame; } push;

// Nodes front to back. A node has the depth and the id of its front fragment.
struct PixelState {
  float depth[NODES];  // empty: -1, behind everything
  uint id[NODES];
  NodeColor color[NODES];
};

void openPixel(uvec2 pixel, out PixelState state) {
  [[unroll]] for (uint i = 0u; i < NODES; ++i) {
    state.depth[i] = -1.0;
    state.id[i] = ~0u;
    state.color[i] = packNode(vec4(0.0, 0.0, 0.0, 1.0));
  }
}

// Front over back: premultiplied color, transmittance.
NodeColor merged(NodeColor front, NodeColor back) {
  const vec4 a = unpackNode(front), b = unpackNode(back);
  return packNode(vec4(a.rgb + a.a * b.rgb, a.a * b.a));
}

// The node that is merged with the one behind it; NODES - 1 is merged with `last`, which has no place.
uint merges(PixelState state, NodeColor last) {
#if LEAST_ERROR
  // What is lost is the order of the back node and of fragments that are still to come between the two. It counts by
  // how much of the pixel the back node covers as it is seen now.
  float visible = 1.0, least = 2.0;
  uint best = 0u;
  [[unroll]] for (uint i = 0u; i < NODES; ++i) {
    visible *= unpackNode(state.color[i]).a;
    const float covers = visible * (1.0 - unpackNode(i + 1u < NODES ? state.color[min(i + 1u, NODES - 1u)] : last).a);
    if (covers <= least) {  // of equals, the farthest
      least = covers;
      best = i;
    }
  }
  return best;
#else
  return NODES - 1u;
#endif
}

bool addFragment(inout PixelState state, Fragment f) {
  vec4 straight;
  if (!shadeFragment(f, straight)) return false;
  // Where the node belongs, it takes the place of the one behind, and so on.
  float depth = f.depth;
  uint id = f.id;
  NodeColor color = packNode(vec4(straight.rgb * straight.a, 1.0 - straight.a));
  [[unroll]] for (uint i = 0u; i < NODES; ++i) {
    if (!isInFront(depth, id, state.depth[i], state.id[i])) continue;
    const float nextDepth = state.depth[i];
    const uint nextId = state.id[i];
    const NodeColor nextColor = state.color[i];
    state.depth[i] = depth;
    state.id[i] = id;
    state.color[i] = color;
    depth = nextDepth;
    id = nextId;
    color = nextColor;
  }
  if (depth < 0.0) return true;  // there was an empty node
  const uint front = merges(state, color);
  [[unroll]] for (uint i = 0u; i < NODES; ++i) {
    const bool isLast = i + 1u == NODES;
    const uint next = min(i + 1u, NODES - 1u);
    const NodeColor nextColor = isLast ? color : state.color[next];
    if (i == front) state.color[i] = merged(state.color[i], nextColor);
    if (i <= front) continue;
    state.depth[i] = isLast ? depth : state.depth[next];
    state.id[i] = isLast ? id : state.id[next];
    state.color[i] = nextColor;
  }
  return true;
}

bool closePixel(PixelState state, out vec4 color) {
  vec3 sum = vec3(0.0);
  float transmittance = 1.0;
  [[unroll]] for (uint i = 0u; i < NODES; ++i) {
    const vec4 node = unpackNode(state.color[i]);
    sum += transmittance * node.rgb;
    transmittance *= node.a;
  }
  color = vec4(sum, 1.0 - transmittance);
  return true;
}
