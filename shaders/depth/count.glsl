// Adds one for every transparent fragment in front of the opaque depth: those that methods blend.
#include "depth/count.h"
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform Push { CountPush push; };

void fragment(Fragment f) {
  vec4 color;
  // Only whether the fragment is there at all is of interest: alpha may cut it away.
  if (hasCutoff(f) && !shadeFragment(f, color)) return;
  atomicAdd(push.counts.at[f.index], 1u);
}
