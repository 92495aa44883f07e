#version 460
// The hardware source: fragments from the rasterizer, handed to a fragment program (source/fragment.glsl).
#include "common/pixel.glsl"
#include "common/surface_input.glsl"

struct SourceFragment {
  Surface surface;
  uint material;
  float invW;
};
#include "source/fragment.glsl"

#include "FRAGMENT_PROGRAM"

bool shadeFragment(Fragment f, out vec4 color) {
  return shade(push.frame.c.materials.at[f.source.material], f.source.surface, color);
}

float viewDistance(Fragment f) { return 1.0 / f.source.invW; }

bool hasCutoff(Fragment f) { return push.frame.c.materials.at[f.source.material].alphaCutoff > 0.0; }

// Has derivatives: call it before the invocations of a quad part.
Fragment thisFragment() {
  Fragment f;
  f.pixel = uvec2(gl_FragCoord.xy);
  f.index = pixelIndex(push.frame.c.size);
  f.depth = gl_FragCoord.z;
#if HAS_ID
  f.id = push.frame.c.transparentIds.at[gl_PrimitiveID];
#else
  f.id = 0u;
#endif
  f.samples = 1u;
  f.source = SourceFragment(surfaceInput(), inMaterial, gl_FragCoord.w);
  return f;
}

#if ACCESS == ACCESS_NONE
// Without it the depth test would come after the program's stores. Helper invocations need no care: their stores and
// atomics have no effect.
layout(early_fragment_tests) in;

void main() { fragment(thisFragment()); }
#elif ACCESS == ACCESS_BLENDED
layout(location = 0) out vec4 outContributions[CONTRIBUTIONS];

void main() {
  vec4 c[CONTRIBUTIONS];
  if (!contribute(thisFragment(), c)) discard;
  outContributions = c;
}
#endif
