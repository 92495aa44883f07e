// The states of an exclusive program's pixels in memory. The includer has included the fragment program.
#ifndef OITLAB_SOURCE_PIXEL_STATES_GLSL
#define OITLAB_SOURCE_PIXEL_STATES_GLSL

#include "source/state_types.h"

// `coherent`: an invocation sees what the one before it in the critical section stored.
layout(buffer_reference, scalar, buffer_reference_align = 16) coherent buffer PixelStateBuffer { PixelState at[]; };

TakenBuffer takenOfPixels() { return PixelStateConstantsBuffer(uint64_t(push.frame)).c.taken; }

PixelStateBuffer statesOfPixels() {
  return PixelStateBuffer(PixelStateConstantsBuffer(uint64_t(push.frame)).c.states);
}

#endif
