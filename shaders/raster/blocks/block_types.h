// Half-blocks, and the lists of what triangles cover of them (LucidRaster, Jakubowski 2024, section 2, stage 3). C++
// and GLSL both include this.
#ifndef OITLAB_RASTER_BLOCK_TYPES_H
#define OITLAB_RASTER_BLOCK_TYPES_H

#include "raster/raster_types.h"

#ifdef __cplusplus
namespace oitlab::raster {
#endif

// A half-block has 8 x 4 pixels. A bin has 4 columns and 8 rows of them. Its number in the frame is
// bin * 32 + row * 4 + column. Bit y * 8 + x of a coverage mask is the pixel (x, y) of the half-block.
#define HALF_BLOCK_WIDTH 8u
#define HALF_BLOCK_HEIGHT 4u
#define HALF_BLOCKS_ACROSS 4u
#define HALF_BLOCKS 32u  // of a bin

// Lists are of three kinds, by their length in tri-half-blocks. Users of the lists may sort the kinds in different
// ways (section 2, phase 2). SHORT_LIST is the longest that a subgroup sorts in passing.
#define SHORT_LIST 64u
#define MEDIUM_LIST 512u

// The longest list that a subgroup sorts at once. Longer ones are sorted in runs of this length, which are merged.
#define SORTED_RUN 1024u
#define MERGE_GROUP 256u  // elements of a workgroup of order_merge.comp

// Passes of blocks.comp.
#define COUNT_AND_WRITE_LOW 0
#define COUNT_HIGH 1
#define WRITE_HIGH 2

// What blocks.comp stores beside each tri-half-block, for an order to be made of.
#define KEY_NONE 0
#define KEY_DEPTH 1     // 1 / w at the centroid of the covered samples, as bits that sort like it
#define KEY_ID 2        // primitive id

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

// Some pixels of a half-block, as bits of a coverage mask.
struct PixelJob {
  HalfBlock block;
  uint pixels;
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

// Counted by blocks.comp, zeroed before. A method may keep counters of its own behind these.
struct BlockCounters {
  uint triHalfBlocks;                       // in all lists; more than the capacity means overflow
  uint shortLists, mediumLists, longLists;  // half-blocks by the length of their list
  uint cached;                              // by segments of high bins; more than the capacity means overflow
  uint overflow;                            // 1: some list does not fit, so that none may be read
  uint longest;                             // tri-half-blocks of the longest list
  Dispatch shortGroups, mediumGroups;       // one workgroup per SHORT_TEAMS or MEDIUM_TEAMS half-blocks
  Dispatch longGroups;                      // one workgroup per half-block
  // With COUNT_ALL:
  uint allLists;
  Dispatch allGroups;                       // one workgroup per SHORT_TEAMS half-blocks, of any kind
  Dispatch runGroups;                       // x: runs of the longest list, y: long lists
  Dispatch mergeGroups;                     // x: MERGE_GROUP elements each of the longest list, y: long lists
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer TriHalfBlockBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer CachedBuffer { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HalfBlockBuffer { HalfBlock at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PixelJobBuffer { PixelJob at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBlockBuffer { BinBlock at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SegmentListsBuffer { SegmentLists at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BlockCounterBuffer { BlockCounters c; };
#endif

struct BlocksPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(WordBuffer) entries;
  ADDRESS_OF(SegmentBuffer) segments;
  ADDRESS_OF(RasterCounterBuffer) rasterCounters;
  ADDRESS_OF(TriHalfBlockBuffer) list;
  ADDRESS_OF(WordBuffer) keys;         // parallel to `list`: what to sort by (KEY_*)
  ADDRESS_OF(HalfBlockBuffer) blocks;  // those of short lists from 0 up, of long ones from the end down
  ADDRESS_OF(PixelJobBuffer) medium;   // half-blocks of medium lists, with all their pixels
  ADDRESS_OF(BinBlockBuffer) binBlocks;
  ADDRESS_OF(SegmentListsBuffer) segmentLists;  // one per segment of a high bin
  ADDRESS_OF(BlockCounterBuffer) counters;
  uint listCapacity;  // of `list`, even; cached tri-half-blocks lie behind it
  uint cachedCapacity;
};

#ifdef __cplusplus
static_assert(sizeof(BlocksPush) <= 128);
}  // namespace oitlab::raster
#endif

#endif
