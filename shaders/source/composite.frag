#version 460
// The end of ACCESS_BLENDED and ACCESS_EXCLUSIVE on hardware: the sums of a pixel, which were blended into images, or
// its state, over what is opaque.
#include "common/bindings.glsl"
#include "common/pixel.glsl"

struct SourceFragment {
  uint none;
};
#include "source/fragment.glsl"

#include "FRAGMENT_PROGRAM"

// Not called here; the program's contribute() or addFragment() names them.
bool shadeFragment(Fragment f, out vec4 color) {
  color = vec4(0.0);
  return false;
}
float inverseDistance(Fragment f) { return 0.0; }
bool hasCutoff(Fragment f) { return false; }

layout(location = 0) out vec4 outColor;  // premultiplied

#if ACCESS == ACCESS_EXCLUSIVE
#include "source/pixel_states.glsl"

void main() {
  const uint pixel = pixelIndex(push.frame.c.size);
  if (takenOfPixels().at[pixel] == 0u || !closePixel(statesOfPixels().at[pixel], outColor)) discard;
}
#else
void main() {
  vec4 sums[CONTRIBUTIONS];
  [[unroll]] for (int i = 0; i < CONTRIBUTIONS; ++i)
    sums[i] = texelFetch(methodImages[i], ivec2(gl_FragCoord.xy), 0);
  if (!composite(sums, outColor)) discard;
}
#endif
