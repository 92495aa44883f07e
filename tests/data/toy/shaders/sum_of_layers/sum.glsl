// Light adds up, whatever is in front.
#include "source/fragment.glsl"
#include "sum_of_layers/sum_types.h"

layout(push_constant, scalar) uniform PushBlock { SumPush push; };

bool contribute(Fragment f, out vec4 c[1]) {
  vec4 color;
  if (!shadeFragment(f, color)) return false;
  c[0] = vec4(push.strength * color.a * color.rgb, 0.0);
  return true;
}

// With alpha 0 the light hides nothing of the opaque color.
bool composite(vec4 sums[1], out vec4 color) {
  color = vec4(sums[0].rgb, 0.0);
  return true;
}
