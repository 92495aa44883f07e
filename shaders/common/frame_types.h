// What is constant over a frame. C++ and GLSL both include this (scalar block layout).
#ifndef OITLAB_FRAME_TYPES_H
#define OITLAB_FRAME_TYPES_H

#include "common/scene_types.h"

#ifdef __cplusplus
namespace oitlab {
using uvec2 = glm::uvec2;
// A buffer reference is a 64-bit device address.
#define ADDRESS_OF(T) std::uint64_t
#else
#define ADDRESS_OF(T) T
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer VertexBuffer { Vertex at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer MaterialBuffer { GpuMaterial at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer UintBuffer { uint at[]; };
#endif

struct FrameConstants {
  mat4 viewProjection;  // world to clip: y down, reversed infinite depth (near / distance)
  uvec2 size;           // pixels
  ADDRESS_OF(VertexBuffer) vertices;
  ADDRESS_OF(MaterialBuffer) materials;
  ADDRESS_OF(UintBuffer) transparentIds;  // primitive id of the n-th submitted triangle
};

#ifdef __cplusplus
}  // namespace oitlab
#else
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer FrameBuffer { FrameConstants c; };
#endif

#endif
