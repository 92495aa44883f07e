// LucidRaster (Jakubowski 2024), section 2, stage 3: what its shaders share. C++ and GLSL both
// include this.
#ifndef OITLAB_LUCID_TYPES_H
#define OITLAB_LUCID_TYPES_H

#include "common/lists.h"
#include "raster/raster_types.h"

#ifdef __cplusplus
namespace oitlab::lucid {
using namespace oitlab::raster;
#endif

// A half-block is 8 x 4 pixels: 4 across and 8 down in a bin. Its number in the frame is
// bin * 32 + row * 4 + column. Bit y * 8 + x of a coverage mask is the pixel (x, y) of the half-block.
#define HALF_BLOCK_WIDTH 8u
#define HALF_BLOCK_HEIGHT 4u
#define HALF_BLOCKS_ACROSS 4u
#define HALF_BLOCKS 32u  // of a bin

// Tri-half-blocks that are sorted in shared memory (section 2, phase 2).
#define ORDERED_LIST 64u  // by ordered raster, on the way
#define LOW_LIST 512u     // by sort_lists.comp, for low raster
#define HIGH_LIST 1024u   // for high raster; what is longer goes to repair.comp
#define REPAIR_LIST 1024u // fragments of a pixel that repair.comp sorts in shared memory
#define ROW_REPAIR 256u   // lists longer than this are repaired by rows of pixels

// Flags of BlendPush and RepairPush.
#define COUNT_SAMPLES 1u
#define REPAIR 2u
#define SHOW_ERRORS 4u

// The part of a triangle in one half-block: tri-half-block. In memory an uvec2, one transaction.
struct TriHalfBlock {
  uint triangle;  // slot
  uint mask;      // coverage
};

// The list of a half-block: tri-half-blocks [first, first + count), in no order.
struct HalfBlock {
  uint number;
  uint first, count;
};

// Of each half-block of a bin that blocks.comp counts in several parts.
struct BinBlock {
  uint count, first;  // its list
  uint partsDone;      // of the bin; in its first half-block
};

// Of each part of a high bin, from counting to writing.
struct PartLists {
  uint first[HALF_BLOCKS];  // places of its tri-half-blocks in the half-blocks' lists
  uint kept, keptFirst;     // what it kept, and where; none where it was too much
};

// A tri-half-block on its way from counting to writing: mask; slot; depth key; half-block of the bin,
// and place in its part's share of that half-block's list.
#define KEPT_PLACE_SHIFT 5

// Pixels of a half-block to be blended again, by the depth filter or in exact order.
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
#define DEEP_PART 4096u   // tri-half-blocks that it goes through

struct LucidCounters {
  uint triHalfBlocks;          // of all lists: more than the capacity means overflow
  uint orderedLists;           // half-blocks of at most ORDERED_LIST
  uint lowLists, highLists;    // longer ones, and those of more than LOW_LIST
  uint kept;                   // by parts of high bins: more than the capacity means overflow
  uint overflow;               // 1: some list does not fit, and none is to be read
  uint walked, expected;       // entries gone through and entries there were: equal, or loops ended early
  uint blended;                // tri-half-blocks gone through by the raster stages; see VERIFY_LOOPS
  uint passedOn;               // those of them that go through two stages
  uint passedJobs;             // half-blocks with pixels that ordered raster passed on to low raster
  uint pixelsToRepair;
  uint repairJobs;             // more than the capacity means overflow
  uint deepPixels;             // pixels too deep for repair.comp: more than the capacity means overflow
  uint deepNodes;              // their fragments: more than the capacity means overflow
  uint deepCaptured, deepBlended;  // the same number, or the image is not to be trusted
  uint unfinished;             // deep pixels whose sort wants more rounds
  uint invalidPixels, repairedPixels;
  uint samples;                // fragments: covered, in front of opaque, not cut out
  Dispatch ordered, low;       // one workgroup for ORDERED_TEAMS or LOW_TEAMS half-blocks
  Dispatch high, repair;       // for one half-block, for one job
  Dispatch deep;               // x: deep pixels, y: parts of the longest of their lists
  Dispatch deepResolve;        // x: DEEP_RESOLVE_GROUP deep pixels each
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer TriHalfBlockBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer KeptBuffer { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HalfBlockBuffer { HalfBlock at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBlockBuffer { BinBlock at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PartListsBuffer { PartLists at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PixelJobBuffer { PixelJob at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LucidCounterBuffer { LucidCounters c; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DeepPixelBuffer { DeepPixel at[]; };
#endif

struct BlocksPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(WordBuffer) entries;
  ADDRESS_OF(PartBuffer) parts;
  ADDRESS_OF(RasterCounterBuffer) rasterCounters;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) keys;         // parallel to list: depth to sort by
  ADDRESS_OF(HalfBlockBuffer) blocks;  // ordered ones from 0 up, high ones from the end down
  ADDRESS_OF(PixelJobBuffer) filterJobs;
  ADDRESS_OF(BinBlockBuffer) binBlocks;
  ADDRESS_OF(PartListsBuffer) partLists;  // of each part of a high bin
  ADDRESS_OF(LucidCounterBuffer) counters;
  uint listCapacity;  // of list, even; the kept tri-half-blocks lie behind that
  uint keptCapacity;
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
