// The contract between a fragment source and a method's fragment program (docs/sources.md). The source defines
// SourceFragment, includes this, then the program, and calls the functions of the program's access.
//
// The program declares `push`, whose first member is `frame`, and for its ACCESS:
//   ACCESS_NONE       void fragment(Fragment f);
//                     It has its own buffers and atomics. Fragments come in any order.
//   ACCESS_BLENDED    bool contribute(Fragment f, out vec4 c[CONTRIBUTIONS]);
//                     Each c is combined with the pixel's sum of it, by an operation that C++ states. False: the
//                     fragment is cut out.
//                     bool composite(vec4 sums[CONTRIBUTIONS], out vec4 color);
//                     The pixel's premultiplied color. False: nothing is there. Not needed on the target itself.
//   ACCESS_EXCLUSIVE  struct PixelState
//                     void openPixel(uvec2 pixel, out PixelState state);
//                     bool addFragment(inout PixelState state, Fragment f);  // false: it is cut out, nothing changed
//                     bool closePixel(PixelState state, out vec4 color);     // as composite()
//                     One invocation at a time works on a pixel.
#ifndef OITLAB_SOURCE_FRAGMENT_GLSL
#define OITLAB_SOURCE_FRAGMENT_GLSL

#include "common/frame_types.h"
#include "source/access.h"

// A transparent fragment that is not behind the opaque depth of its pixel.
struct Fragment {
  uvec2 pixel;
  uint index;    // of the pixel in buffers of one element per pixel, rows top to bottom
  float depth;   // reversed: near / distance. Larger is nearer
  uint id;       // primitive id; breaks ties of depth, the lower one in front
  uint samples;  // coverage mask of the pixel's samples: 1
  SourceFragment source;
};

// The color, straight and linear. False: the material's cutoff removes the fragment. Shading is not free: call it when
// the color is needed.
bool shadeFragment(Fragment f, out vec4 color);

// 1 / distance from the eye plane, in scene units: depth / near, but for rounding.
float inverseDistance(Fragment f);

// Whether shadeFragment() can return false.
bool hasCutoff(Fragment f);

#endif
