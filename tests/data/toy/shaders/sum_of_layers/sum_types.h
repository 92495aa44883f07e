// C++ and GLSL both include this file.
#ifndef OITLAB_SUM_OF_LAYERS_TYPES_H
#define OITLAB_SUM_OF_LAYERS_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::sum_of_layers {
#endif

struct SumPush {
  ADDRESS_OF(FrameBuffer) frame;
  float strength;
};

#ifdef __cplusplus
}  // namespace oitlab::sum_of_layers
#endif

#endif
