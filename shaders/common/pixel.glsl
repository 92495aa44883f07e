// The pixel of a fragment shader's invocation.
#ifndef OITLAB_PIXEL_GLSL
#define OITLAB_PIXEL_GLSL

// Its place in buffers of one element a pixel, rows top to bottom.
//
// At the edges of a target of an odd width or height quads reach beyond it. Their helper invocations
// load like others, and no address is checked: they get the nearest pixel's.
uint pixelIndex(uvec2 size) {
  const uvec2 at = min(uvec2(gl_FragCoord.xy), size - 1u);
  return at.y * size.x + at.x;
}

#endif
