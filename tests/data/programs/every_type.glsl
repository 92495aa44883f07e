// A state with members of every type, and with gaps between them.
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform PushBlock { FrameBuffer frame; } push;

struct Inner {
  uint64_t wide;
  bool flag;
};

struct PixelState {
  float first;
  uint64_t key;
  bool flags[3];
  vec3 three;
  mat3x4 matrix;
  Inner inner[2];
  FrameBuffer address;
  uint last;
};

void openPixel(uvec2 pixel, out PixelState state) {
  state.first = 0.0;
  state.key = 0ul;
  state.flags = bool[](false, false, false);
  state.three = vec3(0.0);
  state.matrix = mat3x4(0.0);
  state.inner[0] = state.inner[1] = Inner(0ul, false);
  state.address = push.frame;
  state.last = pixel.x;
}

bool addFragment(inout PixelState state, Fragment f) {
  state.first += f.depth;
  state.key += f.id;
  state.flags[f.id % 3u] = true;
  state.three.z += 1.0;
  state.matrix[2][3] += 1.0;
  state.inner[1] = Inner(state.key, state.flags[1]);
  return true;
}

bool closePixel(PixelState state, out vec4 color) {
  color = vec4(state.first * state.three, state.flags[2] && state.inner[1].flag ? 1.0 : state.matrix[2][3]) +
          float(state.last + state.address.c.size.x);
  return true;
}
