// C++ and GLSL both include this.
#ifndef OITLAB_WBOIT_TYPES_H
#define OITLAB_WBOIT_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::wboit {
#endif

struct WboitPush {
  ADDRESS_OF(FrameBuffer) frame;
  float overDepthScale;  // 1 / scene units to 1 / those of the paper's constants
  float nearest;     // scene units, > 0: depth range of the scene, for equation 10
  float farthest;
};

#ifdef __cplusplus
}  // namespace oitlab::wboit
#endif

#endif
