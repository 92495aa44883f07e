// C++ and GLSL both include this.
#ifndef OITLAB_LOCAL_MEMORY_TYPES_H
#define OITLAB_LOCAL_MEMORY_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::local_memory {
#endif

struct Push {
  ADDRESS_OF(FrameBuffer) frame;
  uint zero;  // 0, which a compiler cannot know
};

#ifdef __cplusplus
}  // namespace oitlab::local_memory
#endif

#endif
