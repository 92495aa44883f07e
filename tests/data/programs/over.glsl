// Plain blending as an exclusive program: the image depends on the order in which fragments come.
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform PushBlock { FrameBuffer frame; } push;

struct PixelState {
  vec4 color;  // premultiplied
};

void openPixel(uvec2 pixel, out PixelState state) { state.color = vec4(0.0); }

bool addFragment(inout PixelState state, Fragment f) {
  vec4 color;
  if (!shadeFragment(f, color)) return false;
  state.color = vec4(color.rgb * color.a, color.a) + (1.0 - color.a) * state.color;
  return true;
}

bool closePixel(PixelState state, out vec4 color) {
  color = state.color;
  return true;
}
