// What the hardware source keeps of each pixel for exclusive programs, in memory. C++ and GLSL both include this.
#ifndef OITLAB_SOURCE_STATE_TYPES_H
#define OITLAB_SOURCE_STATE_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab {
#else
// By pixel: how many fragments its program took. 0: its state is not there yet.
layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer TakenBuffer { uint at[]; };
#endif

// FrameConstants, with what the source adds. The address of it stands for that of FrameConstants in a program's push
// constants: these belong to the method.
struct PixelStateConstants {
  FrameConstants frame;  // must be first
  ADDRESS_OF(TakenBuffer) taken;
  uint64_t states;  // by pixel: PixelState, which is the program's
};

struct CountTakenPush {
  ADDRESS_OF(TakenBuffer) taken;
  ADDRESS_OF(TakenBuffer) sum;  // a single one; must be 0
  uint pixels;
  uint invocations;  // of the dispatch
};

#define COUNT_TAKEN_GROUP 256u

#ifdef __cplusplus
}  // namespace oitlab
#else
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PixelStateConstantsBuffer {
  PixelStateConstants c;
};
#endif

#endif
