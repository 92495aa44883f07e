// McGuire and Bavoil 2013, section 4: premultiplied color and alpha, weighted, are summed up; the product of (1 - alpha),
// the revealage, is another sum. Neither depends on the order of fragments.
#include "source/fragment.glsl"
#include "wboit/weight.glsl"
#include "wboit/wboit_types.h"

layout(push_constant, scalar) uniform PushBlock { WboitPush push; };

bool contribute(Fragment f, out vec4 c[2]) {
  vec4 color;
  if (!shadeFragment(f, color)) return false;
  const float overZ = inverseDistance(f), range = max(push.farthest - push.nearest, 1e-20);
  // As the depth buffer of a projection onto [nearest, farthest] has it (the paper's d(z)).
  const float d = clamp(push.farthest * (1.0 - push.nearest * overZ) / range, 0.0, 1.0);
  const float w = weight(overZ * push.overDepthScale, d, color.a);
  c[0] = vec4(color.rgb * color.a, color.a) * w;
  c[1] = vec4(color.a);
  return true;
}

// The weighted mean color, as visible as the revealage leaves it.
bool composite(vec4 sums[2], out vec4 color) {
  const float revealage = sums[1].r;
  vec4 sum = sums[0];
  // As the paper's listing does: where half floats overflowed, white is better than not a number.
  if (any(isinf(sum.rgb))) sum = vec4(1.0);
  const vec3 mean = sum.rgb / max(sum.a, 1e-5);
  color = vec4(mean, 1.0) * (1.0 - revealage);
  return revealage != 1.0;  // else nothing transparent is here
}
