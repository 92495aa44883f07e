// Sorts triangles back to front by their centroids. C++ and GLSL both include this.
#ifndef OITLAB_BLEND_SORT_TYPES_H
#define OITLAB_BLEND_SORT_TYPES_H

#include "common/sort/sort_types.h"

#ifdef __cplusplus
namespace oitlab::blend {
#endif

struct CentroidPush {
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(SortBuffer) submitted;  // vertex indices, three a triangle, as submitted
  ADDRESS_OF(SortBuffer) sorted;     // the same, back to front
  ADDRESS_OF(SortBuffer) sequence;   // by primitive id: the place in `sorted`; null: not wanted
  ADDRESS_OF(SortBuffer) keys;
  ADDRESS_OF(SortBuffer) values;  // places in the submission
  vec3 eye;
  uint count;  // triangles
};

#ifdef __cplusplus
}  // namespace oitlab::blend
#endif

#endif
