// Arguments of zero_fill.comp. C++ and GLSL both include this.
#ifndef OITLAB_ZERO_FILL_H
#define OITLAB_ZERO_FILL_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab {
#endif

#define ZERO_FILL_BUFFERS 4
#define ZERO_FILL_GROUP 256u

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ZeroedBuffer { uint at[]; };
#endif

struct ZeroFillPush {
  ADDRESS_OF(ZeroedBuffer) buffers[ZERO_FILL_BUFFERS];
  uint words[ZERO_FILL_BUFFERS];  // of 4 bytes; 0: no buffer
  uint invocations;               // of the dispatch
};

#ifdef __cplusplus
}  // namespace oitlab
#endif

#endif
