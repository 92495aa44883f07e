// How a node's color is kept: premultiplied color, and transmittance in a. NODE_BITS of each: 8, 16 or 32.
#ifndef OITLAB_MLAB_NODE_COLOR_GLSL
#define OITLAB_MLAB_NODE_COLOR_GLSL

#if NODE_BITS == 8
#define NodeColor uint
NodeColor packNode(vec4 color) { return packUnorm4x8(color); }
vec4 unpackNode(NodeColor color) { return unpackUnorm4x8(color); }
#elif NODE_BITS == 16
#define NodeColor uvec2
NodeColor packNode(vec4 color) { return uvec2(packHalf2x16(color.rg), packHalf2x16(color.ba)); }
vec4 unpackNode(NodeColor color) { return vec4(unpackHalf2x16(color.x), unpackHalf2x16(color.y)); }
#else
#define NodeColor vec4
NodeColor packNode(vec4 color) { return color; }
vec4 unpackNode(NodeColor color) { return color; }
#endif

#endif
