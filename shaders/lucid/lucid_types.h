// LucidRaster (Jakubowski 2024), section 2, stage 3: types that its shaders share. C++ and GLSL both include this.
#ifndef OITLAB_LUCID_TYPES_H
#define OITLAB_LUCID_TYPES_H

#include "common/lists.h"
#include "raster/raster_types.h"

#ifdef __cplusplus
namespace oitlab::lucid {
using namespace oitlab::raster;
#endif

// A half-block has 8 x 4 pixels. A bin has 4 columns and 8 rows of them. Its number in the frame is
// bin * 32 + row * 4 + column. Bit y * 8 + x of a coverage mask is the pixel (x, y) of the half-block.
#define HALF_BLOCK_WIDTH 8u
#define HALF_BLOCK_HEIGHT 4u
#define HALF_BLOCKS_ACROSS 4u
#define HALF_BLOCKS 32u  // of a bin

// The longest lists that are sorted, in tri-half-blocks (section 2, phase 2).
#define ORDERED_LIST 64u  // by ordered raster itself
#define LOW_LIST 512u     // by sort_lists.comp, for low raster
#define HIGH_LIST 1024u   // for high raster; longer lists go to repair.comp
#define REPAIR_LIST 1024u // most fragments of a pixel that repair.comp sorts in shared memory
#define ROW_REPAIR 256u   // longer lists are repaired row by row

// Passes of blocks.comp.
#define COUNT_AND_WRITE_LOW 0
#define COUNT_HIGH 1
#define WRITE_HIGH 2

// Flags of BlendPush and RepairPush.
#define COUNT_SAMPLES 1u
#define REPAIR 2u
#define SHOW_ERRORS 4u

// A tri-half-block: what one triangle covers of one half-block. Stored as a uvec2, so that it is one transaction.
struct TriHalfBlock {
  uint triangle;  // slot
  uint mask;      // coverage
};

// The list of a half-block: tri-half-blocks [first, first + count), unordered.
struct HalfBlock {
  uint number;
  uint first, count;
};

// For each half-block of a bin that blocks.comp counts in several segments.
struct BinBlock {
  uint count, first;  // its list
  uint segmentsDone;    // of the bin; only in its first half-block
};

// For each segment of a high bin, from counting to writing.
struct SegmentLists {
  uint first[HALF_BLOCKS];  // places of its tri-half-blocks in the half-blocks' lists
  uint cached, cachedFirst;     // number and place of its cached tri-half-blocks; more than fit: none are cached
};

// A cached tri-half-block, from counting to writing: mask; slot; depth key; half-block of the bin and, above it, the
// place in its segment's share of that half-block's list.
#define CACHED_PLACE_SHIFT 5

// Pixels of a half-block that must be blended again, with the depth filter or in exact order.
struct PixelJob {
  HalfBlock block;
  uint pixels;
};

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
  uint triHalfBlocks;          // in all lists; more than the capacity means overflow
  uint orderedLists;           // half-blocks with at most ORDERED_LIST
  uint lowLists, highLists;    // longer ones, and those with more than LOW_LIST
  uint cached;                   // by segments of high bins; more than the capacity means overflow
  uint overflow;               // 1: some list does not fit, so that none may be read
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
  Dispatch ordered, low;       // one workgroup per ORDERED_TEAMS or LOW_TEAMS half-blocks
  Dispatch high, repair;       // one workgroup per half-block, per job
  Dispatch deep;               // x: deep pixels, y: chunks of their longest list
  Dispatch deepResolve;        // x: one workgroup per DEEP_RESOLVE_GROUP deep pixels
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer TriHalfBlockBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer CachedBuffer { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HalfBlockBuffer { HalfBlock at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBlockBuffer { BinBlock at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SegmentListsBuffer { SegmentLists at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PixelJobBuffer { PixelJob at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LucidCounterBuffer { LucidCounters c; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DeepPixelBuffer { DeepPixel at[]; };
#endif

struct BlocksPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(WordBuffer) entries;
  ADDRESS_OF(SegmentBuffer) segments;
  ADDRESS_OF(RasterCounterBuffer) rasterCounters;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) keys;         // parallel to `list`: the depths to sort by
  ADDRESS_OF(HalfBlockBuffer) blocks;  // ordered ones from 0 up, high ones from the end down
  ADDRESS_OF(PixelJobBuffer) filterJobs;
  ADDRESS_OF(BinBlockBuffer) binBlocks;
  ADDRESS_OF(SegmentListsBuffer) segmentLists;  // one per segment of a high bin
  ADDRESS_OF(LucidCounterBuffer) counters;
  uint listCapacity;  // of `list`, even; cached tri-half-blocks lie behind it
  uint cachedCapacity;
};

struct BlendPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) keys;
  ADDRESS_OF(HalfBlockBuffer) blocks;
  ADDRESS_OF(PixelJobBuffer) filterJobs;
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
static_assert(sizeof(BlocksPush) <= 128 && sizeof(BlendPush) <= 128);
}  // namespace oitlab::lucid
#endif

#endif
