// What the compute source tells its shaders. C++ and GLSL both include this.
#ifndef OITLAB_SOURCE_COMPUTE_TYPES_H
#define OITLAB_SOURCE_COMPUTE_TYPES_H

#include "raster/blocks/block_types.h"

#ifdef __cplusplus
namespace oitlab {
using namespace oitlab::raster;
#endif

// In which order a pixel's fragments are handed over.
#define DELIVER_ANY 0
#define DELIVER_SUBMISSION 1
#define DELIVER_NEAR_TO_FAR 2  // by depth of the triangles in the half-block, then primitive id
#define DELIVER_FAR_TO_NEAR 3
#define DELIVER_SHUFFLED 4     // a random order for each seed, the same in every frame

// Lists of up to two tri-half-blocks per lane are put in order while they are delivered (order_in_passing.glsl), longer
// ones before (order.comp).
#define ORDERED_IN_PASSING(lanes) (2u * (lanes))

// What an order depends on beside the triangles.
struct OrderRule {
  ADDRESS_OF(WordBuffer) sequence;  // by primitive id: its place in the order of submission; null: the ids are
  uint seed;                        // of DELIVER_SHUFFLED
  uint longest;  // longer lists are not in order yet, since no frame before had one; this frame is repeated
};

// Counted after BlockCounters.
struct SourceCounters {
  BlockCounters lists;  // must be first
  uint delivered;       // tri-half-blocks that went through compute.comp, if VERIFY_LOOPS
  uint fragments;       // that the program took, in instrumented frames
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SourceCounterBuffer { SourceCounters c; };
#endif

// FrameConstants, with what the source adds. The address of it stands for that of FrameConstants in a program's push
// constants: these belong to the method.
struct SourceConstants {
  FrameConstants frame;  // must be first
  Mesh mesh;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) order;        // parallel to `list`: its places in the order of delivery
  ADDRESS_OF(HalfBlockBuffer) blocks;  // as BlocksPush
  ADDRESS_OF(PixelJobBuffer) medium;
  ADDRESS_OF(SourceCounterBuffer) counters;
  OrderRule rule;
  uint halfBlocks;
  uint counting;  // 1 in instrumented frames
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer OrderPairBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SourceBuffer { SourceConstants c; };
#endif

struct OrderPush {
  Mesh mesh;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) keys;         // replaced by the order
  ADDRESS_OF(HalfBlockBuffer) blocks;
  ADDRESS_OF(PixelJobBuffer) medium;
  ADDRESS_OF(SourceCounterBuffer) counters;
  OrderRule rule;
  ADDRESS_OF(OrderPairBuffer) from;    // runs of long lists, parallel to `list`: key, place
  ADDRESS_OF(OrderPairBuffer) to;
  uint halfBlocks;
  uint run;   // length of the sorted runs that a merge begins with; 0: no list has more than one
  uint last;  // 1: this merge is the last
};

#ifdef __cplusplus
static_assert(sizeof(OrderPush) <= 128);
}  // namespace oitlab
#endif

#endif
