// What the passes of the A-buffer share. C++ and GLSL both include this.
#ifndef OITLAB_ABUFFER_TYPES_H
#define OITLAB_ABUFFER_TYPES_H

#include "common/lists.h"

#ifdef __cplusplus
namespace oitlab::abuffer {
#endif

// Intervals of fragments a pixel in powers of two (section 3): 1-8, 9-16, ... 513-1024.
#define SMALLEST_INTERVAL 8u
#define MOST_INTERVALS 8u
#define BINS 9u  // for the statistics: the intervals, and what is deeper than all of them

#define SORT_INSERTION 0
#define SORT_MERGE 1
#define SORT_SHELL 2
#define SORT_BITONIC 3
#define SORT_REGISTER 4

// Pixels of a list are dealt out in workgroups of 64, 32,768 of them a row: a dispatch may have no
// more than 65,535 in one direction.
#define LIST_GROUP 64u
#define LIST_GROUPS_X 32768u

// How many workgroups a list of some length takes: the arguments of an indirect dispatch.
struct Groups {
  uint x, y, z;
};

struct Counters {
  uint fragments;   // captured, or that would have been: more than the pool holds means overflow
  uint deepPixels;  // of more fragments than max_fragments, or than a stencil can count
  Groups deepGroups;
  uint unfinished;  // deep pixels whose sort wants more rounds than were recorded
  uint broken;      // deep pixels whose list is not one: none, or the method is at fault
  // Of instrumented frames, from the tallies (tally.comp).
  uint blended;             // fragments
  uint deepest;             // most fragments of one pixel
  uint covered;             // pixels
  uint truncatedPixels;     // pixels of which fragments were left out
  uint truncatedFragments;  // those fragments
  uint pixels[BINS];        // by interval of their number of fragments
};

// The pixels of one interval: arguments of its draws (none where it has no pixels) and its list.
struct Interval {
  uint vertexCount, instanceCount, firstVertex, firstInstance;
  Groups groups;
  uint pixels;
  uint begin;   // of its part of the lists
  uint cursor;  // up to where they are filled
};

// A pixel that is too deep for the local array.
struct DeepPixel {
  uint pixel;
  uint run;  // length of the sorted runs that a round ended with; LIST_END: it is done
};

// Written in instrumented frames: how many fragments of a pixel were blended, how many left out.
struct Tally {
  uint blended, leftOut;
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterBuffer { Counters c; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer IntervalBuffer { Interval at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DeepBuffer { DeepPixel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer TallyBuffer { Tally at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CountBuffer { uint at[]; };

// The interval (0, 1, ...) of a number of fragments above 0.
uint intervalOf(uint fragments) {
  return fragments <= SMALLEST_INTERVAL ? 0u : uint(findMSB(fragments - 1u)) - 2u;
}

// The place in its list of an invocation of workgroup `group`.
uint indexInList(uvec3 group, uint invocation) {
  return (group.y * LIST_GROUPS_X + group.x) * LIST_GROUP + invocation;
}
#endif

struct Push {
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(NodeBuffer) nodes;
  ADDRESS_OF(HeadBuffer) heads;          // one a pixel
  ADDRESS_OF(CountBuffer) counts;        // one a pixel: fragments; where the masks need them
  ADDRESS_OF(CounterBuffer) counters;
  ADDRESS_OF(IntervalBuffer) intervals;
  ADDRESS_OF(CountBuffer) lists;         // ids of pixels, interval by interval
  ADDRESS_OF(DeepBuffer) deep;
  ADDRESS_OF(TallyBuffer) tallies;       // one a pixel
  uint capacity;                         // nodes
  uint deepCapacity;                     // pixels
  uint interval, intervalCount;          // this one, and how many there are
  uint low, high;                        // this interval has pixels of low < fragments <= high
  uint maxFragments;
  uint counting;                         // 1 in instrumented frames
  uint round, rounds;                    // of the deep pixels' sort
};

#ifdef __cplusplus
}  // namespace oitlab::abuffer
#else
layout(push_constant, scalar) uniform PushBlock { Push push; };

// Nodes that are in lists: indices below it.
uint nodesInLists() { return min(push.counters.c.fragments, push.capacity); }
#endif

#endif
