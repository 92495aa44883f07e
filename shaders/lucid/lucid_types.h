// LucidRaster (Jakubowski 2024), section 2, stage 3: types that its shaders share. C++ and GLSL both include this.
#ifndef OITLAB_LUCID_TYPES_H
#define OITLAB_LUCID_TYPES_H

#include "common/lists.h"
#include "raster/blocks/block_types.h"

#ifdef __cplusplus
namespace oitlab::lucid {
using namespace oitlab::raster;
#endif

// Ordered raster sorts short lists itself, sort_lists.comp medium ones for low raster, and long ones up to HIGH_LIST
// tri-half-blocks for high raster (section 2, phase 2).
#define HIGH_LIST 1024u   // for high raster; longer lists go to repair.comp
#define REPAIR_LIST 1024u // most fragments of a pixel that repair.comp sorts in shared memory
#define ROW_REPAIR 256u   // longer lists are repaired row by row

// Flags of BlendPush and RepairPush.
#define COUNT_SAMPLES 1u
#define REPAIR 2u
#define SHOW_ERRORS 4u

// A pixel whose fragments go into a linked list.
struct DeepPixel {
  HalfBlock block;
  uint bit;   // of the coverage masks
  uint head;  // index of a node, or LIST_END
  uint run;   // length of the sorted runs that a round of the sort ended with
  uint done;  // 1: blended
};

#define DEEP_GROUP 64u    // invocations of a workgroup of deep_capture.comp
#define DEEP_RESOLVE_GROUP 8u  // pixels of a workgroup of deep_resolve.comp
#define DEEP_CHUNK 4096u   // tri-half-blocks that one of its workgroups reads

struct LucidCounters {
  BlockCounters lists;         // must be first
  uint walked, expected;       // list entries read by repair.comp, and those there were: unequal if loops ended early
  uint blended;                // tri-half-blocks read by the raster stages, if VERIFY_LOOPS
  uint passedOn;               // those of them that two stages read
  uint passedJobs;             // half-blocks with pixels that ordered raster passed on to low raster
  uint pixelsToRepair;
  uint repairJobs;             // more than the capacity means overflow
  uint deepPixels;             // pixels too deep for repair.comp: more than the capacity means overflow
  uint deepNodes;              // their fragments: more than the capacity means overflow
  uint deepCaptured, deepBlended;  // unequal to deepNodes: the image is wrong
  uint unfinished;             // deep pixels whose sort wants more rounds
  uint invalidPixels, repairedPixels;
  uint samples;                // fragments that are covered, in front of opaque, and not cut out
  Dispatch repair;             // one workgroup per job
  Dispatch deep;               // x: deep pixels, y: chunks of their longest list
  Dispatch deepResolve;        // x: one workgroup per DEEP_RESOLVE_GROUP deep pixels
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LucidCounterBuffer { LucidCounters c; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DeepPixelBuffer { DeepPixel at[]; };
#endif

struct BlendPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) keys;
  ADDRESS_OF(HalfBlockBuffer) blocks;
  ADDRESS_OF(PixelJobBuffer) medium;
  ADDRESS_OF(PixelJobBuffer) repairs;
  ADDRESS_OF(LucidCounterBuffer) counters;
  uint halfBlocks;  // of the frame
  uvec2 size;       // of the frame, pixels
  uint repairCapacity;
  float alphaThreshold;
  uint flags;
};

struct RepairPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(PixelJobBuffer) repairs;
  ADDRESS_OF(LucidCounterBuffer) counters;
  ADDRESS_OF(DeepPixelBuffer) deepPixels;
  ADDRESS_OF(NodeBuffer) nodes;
  uint repairCapacity, deepCapacity, nodeCapacity;
  float alphaThreshold;
  uint flags;
  uint round, rounds;  // of the sort of deep pixels
};

#ifdef __cplusplus
static_assert(sizeof(RepairPush) <= 128);
static_assert(sizeof(BlendPush) <= 128);
}  // namespace oitlab::lucid
#endif

#endif
