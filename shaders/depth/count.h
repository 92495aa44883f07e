// Counts the transparent fragments of each pixel. C++ and GLSL both include this.
#ifndef OITLAB_DEPTH_COUNT_H
#define OITLAB_DEPTH_COUNT_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab {
#endif

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CountBuffer { uint at[]; };
#endif

struct CountPush {
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(CountBuffer) counts;  // one a pixel, rows top to bottom
};

#ifdef __cplusplus
}  // namespace oitlab
#endif

#endif
