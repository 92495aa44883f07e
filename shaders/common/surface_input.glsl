// What common/scene.vert hands to a fragment shader, as a Surface.
#ifndef OITLAB_SURFACE_INPUT_GLSL
#define OITLAB_SURFACE_INPUT_GLSL

#include "common/shade.glsl"

layout(location = 0) in vec3 inNormal;
layout(location = 1) in vec2 inUv;
layout(location = 2) in vec4 inColor;
layout(location = 3) flat in uint inMaterial;

// Quad differences of uv itself would depend on where the 2x2 quad lies. uv / w and 1 / w are linear
// on the screen, so their differences are exact, and the quotient rule gives the derivative at this
// pixel, the same that a compute rasterizer works out from its edge functions.
Surface surfaceInput() {
  const float invW = gl_FragCoord.w;
  const vec2 uvInvW = inUv * invW;
  Surface s;
  s.normal = inNormal;
  s.uv = inUv;
  s.uvDx = (dFdx(uvInvW) - inUv * dFdx(invW)) / invW;
  s.uvDy = (dFdy(uvInvW) - inUv * dFdy(invW)) / invW;
  s.color = inColor;
  return s;
}

#endif
