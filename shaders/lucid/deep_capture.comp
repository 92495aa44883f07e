#version 460
// Captures the fragments of deep pixels (more than REPAIR_LIST fragments) into linked lists (Yang et al. 2010).
// Workgroup (x, y) reads chunk y of the list of deep pixel x's half-block.
#include "common/bindings.glsl"
#include "lucid/lucid_types.h"
#include "raster/blocks/half_block.glsl"

layout(local_size_x = DEEP_GROUP) in;
layout(push_constant, scalar) uniform Push { RepairPush push; };

#include "raster/fragments/prepare.glsl"

void capture(uint number) {
  const HalfBlock block = push.deepPixels.at[number].block;
  const uint bit = push.deepPixels.at[number].bit;
  const ivec2 corner = cornerOf(block.number, push.frame.c.size);
  const vec2 pixel = vec2(pixelOf(bit));
  const float opaque = opaqueDepthAt(push.frame, corner + ivec2(pixel));
  const uint begin = gl_WorkGroupID.y * DEEP_CHUNK;
  const uint end = min(begin + DEEP_CHUNK, block.count);
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += DEEP_GROUP) {
    const TriHalfBlock item = itemAt(push.list, block.first + i);
    if ((item.mask & (1u << bit)) == 0u) continue;
    const Prepared t = prepare(push.mesh, push.frame, item.triangle, corner);
    const float invW = invWOf(t, pixel), depth = depthOf(push.frame, invW);
    if (isHidden(depth, opaque)) continue;
    const uint index = atomicAdd(push.counters.c.deepCaptured, 1u);
    if (index >= push.nodeCapacity) continue;
    vec4 color;
    const bool kept = shadePrepared(push.frame, t, pixel, invW, color);
    if (!kept) color = vec4(-1.0);  // cut out: counted, not blended
    storeNode(push.nodes, index, color, depth, t.id, atomicExchange(push.deepPixels.at[number].head, index));
  }
}

void main() {
  const uint deepPixels = min(push.counters.c.deepPixels, push.deepCapacity);
  for (uint i = gl_WorkGroupID.x; i < deepPixels; i += push.counters.c.deep.x) capture(i);
}
