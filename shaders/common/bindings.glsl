// The few images that a shader cannot reach by address. TARGET_FORMAT (rgba16f, rgba8, rgba32f) is
// defined by the harness for shaders that touch the target.
#ifndef OITLAB_BINDINGS_GLSL
#define OITLAB_BINDINGS_GLSL

layout(set = 0, binding = 0) uniform sampler2D opaqueAtlas;
layout(set = 0, binding = 1) uniform sampler2D transparentAtlas;
#ifdef TARGET_FORMAT
layout(set = 0, binding = 2, TARGET_FORMAT) uniform image2D target;
#endif
// Reversed. In frames of methods that use the compute rasterizer it is of that rasterizer (raster/opaque.frag).
layout(set = 0, binding = 3) uniform sampler2D opaqueDepth;
layout(set = 0, binding = 4) uniform sampler2D methodImages[4];  // a method's own, unfiltered

#endif
