// What a fragment program may do with a pixel, and how contributions are combined. C++ and GLSL both include this.
#ifndef OITLAB_SOURCE_ACCESS_H
#define OITLAB_SOURCE_ACCESS_H

#define ACCESS_NONE 0
#define ACCESS_BLENDED 1
#define ACCESS_EXCLUSIVE 2

// Operations of ACCESS_BLENDED on a sum s and a contribution c. Only the last depends on the order of fragments.
#define COMBINE_ADD 0       // s + c
#define COMBINE_ATTENUATE 1 // s * (1 - c)
#define COMBINE_OVER 2      // c.a * c + (1 - c.a) * s: back-to-front blending of straight colors

#endif
