// The lists of the reference: the pool of nodes, and what is counted.
// C++ and GLSL both include this.
#ifndef OITLAB_REFERENCE_LISTS_H
#define OITLAB_REFERENCE_LISTS_H

#include "common/lists.h"

#ifdef __cplusplus
namespace oitlab::reference {
#endif

struct ListCounters {
  uint fragments;    // captured, or that would have been: more than the pool holds means overflow
  uint deepest;      // most fragments of one pixel
  uint coveredPixels;
  uint resolved;    // fragments that were blended: all of them, or the image is not to be trusted
  uint unfinished;  // pixels whose sort wants more rounds than were recorded
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterBuffer { ListCounters c; };
#endif

struct ListPush {
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(NodeBuffer) nodes;
  ADDRESS_OF(HeadBuffer) heads;
  ADDRESS_OF(CounterBuffer) counters;
  ADDRESS_OF(HeadBuffer) runs;  // per pixel: length of the sorted runs that a round ended with
  uint capacity;                // nodes
  uint round, rounds;           // of the sort; see resolve.comp
};

#ifdef __cplusplus
}  // namespace oitlab::reference
#endif

#endif
