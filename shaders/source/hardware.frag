#version 460
// The hardware source: fragments from the rasterizer, handed to a fragment program (source/fragment.glsl).
#ifdef INTERLOCK
#extension GL_ARB_fragment_shader_interlock : require
#endif
#include "common/pixel.glsl"
#include "common/surface_input.glsl"

struct SourceFragment {
  Surface surface;
  uint material;
  float invW;
  bool isShaded;  // already
  bool isThere;   // then: what shadeFragment() returns
  vec4 color;
};
#include "source/fragment.glsl"

#include "FRAGMENT_PROGRAM"

bool shadeFragment(Fragment f, out vec4 color) {
  color = f.source.color;
  if (f.source.isShaded) return f.source.isThere;
  return shade(push.frame.c.materials.at[f.source.material], f.source.surface, color);
}

float inverseDistance(Fragment f) { return f.source.invW; }

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
  f.source = SourceFragment(surfaceInput(), inMaterial, gl_FragCoord.w, false, false, vec4(0.0));
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
#else
#include "source/pixel_states.glsl"

layout(early_fragment_tests) in;  // as for ACCESS_NONE
#ifdef INTERLOCK
// One invocation per pixel at a time, in the order in which triangles are submitted.
layout(pixel_interlock_ordered) in;
#else
// For tests, on a device that runs the invocations of a pixel in this way by itself.
void beginInvocationInterlockARB() {}
void endInvocationInterlockARB() {}
#endif

void main() {
  // Shading needs no other fragment, so it is done before the critical section, where others would wait for it. What
  // the program does not ask for, the compiler removes.
  Fragment f = thisFragment();
  vec4 color;
  f.source.isThere = shadeFragment(f, color);
  f.source.color = color;
  f.source.isShaded = true;

  TakenBuffer taken = takenOfPixels();
  PixelStateBuffer states = statesOfPixels();
  beginInvocationInterlockARB();
  const uint before = taken.at[f.index];
  PixelState state;
  if (before == 0u) openPixel(f.pixel, state);
  else state = states.at[f.index];
  if (addFragment(state, f)) {
    states.at[f.index] = state;
    taken.at[f.index] = before + 1u;
  }
  endInvocationInterlockARB();
}
#endif
