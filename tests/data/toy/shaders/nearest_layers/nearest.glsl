// A k-buffer: each pixel keeps its KEPT (k) nearest fragments, front to back, and drops the others.
#include "common/order.glsl"
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform PushBlock { FrameBuffer frame; } push;

struct PixelState {
  float depth[KEPT];
  uint id[KEPT];
  vec4 color[KEPT];
};

// Layers that are not there yet are transparent and behind all fragments, whose depth is not negative.
void openPixel(uvec2 pixel, out PixelState state) {
  [[unroll]] for (uint i = 0u; i < KEPT; ++i) {
    state.depth[i] = -1.0;
    state.id[i] = 0u;
    state.color[i] = vec4(0.0);
  }
}

// From the front, each layer that the fragment is in front of makes room by one. All indices are constants, so the
// arrays stay in registers.
bool addFragment(inout PixelState state, Fragment f) {
  vec4 color;
  if (!shadeFragment(f, color)) return false;
  float depth = f.depth;
  uint id = f.id;
  [[unroll]] for (uint i = 0u; i < KEPT; ++i) {
    if (!isInFront(depth, id, state.depth[i], state.id[i])) continue;
    const float nextDepth = state.depth[i];
    const uint nextId = state.id[i];
    const vec4 nextColor = state.color[i];
    state.depth[i] = depth;
    state.id[i] = id;
    state.color[i] = color;
    depth = nextDepth;
    id = nextId;
    color = nextColor;
  }
  return true;
}

bool closePixel(PixelState state, out vec4 color) {
  color = vec4(0.0);
  [[unroll]] for (uint i = 0u; i < KEPT; ++i) color = blendUnder(color, state.color[i]);
  return true;
}
