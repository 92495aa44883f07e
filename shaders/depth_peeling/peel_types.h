// Depth peeling by keys: what a pass knows of a pixel. C++ and GLSL both include this.
#ifndef OITLAB_DEPTH_PEELING_TYPES_H
#define OITLAB_DEPTH_PEELING_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::depth_peeling {
#endif

// The place of a fragment in its pixel's order, as 64 bits: the larger key is in front, and no two
// fragments of a pixel share one, at equal depths neither. 0: there is no (further) fragment.
struct Key {
  uint low;   // complement of the primitive id: the lower id in front
  uint high;  // bits of the depth, reversed and not negative: the larger one is nearer
};

#define LIST_END 0xffffffffu

// A fragment that was peeled from the back, in its pixel's list. They come from back to front, so
// that the list's head is the foremost.
struct BackFragment {
  vec4 color;  // straight, linear
  uint next;   // the one behind it, or LIST_END
};

// VkDrawIndexedIndirectCommand. A pass asks for the next one by its instanceCount: 0 or 1.
struct PassDraw {
  uint indexCount, instanceCount, firstIndex, vertexOffset, firstInstance;
};

struct PeelCounters {
  uint back;          // fragments listed from the back: more than the list holds means overflow
  uint lastBackPass;  // the last pass that blended one from the back; 0: none
  uint broken;        // pixels whose list does not end: none, or the method is at fault
  // Of instrumented frames only:
  uint fragments;  // in front of the opaque depth
  uint blended;
  uint missed;  // those that were left when the last layer was peeled
};

// What a pass does beside blending the keys that the pass before it found.
#define PASS_FINDS 1u       // it looks for the next keys; the last of a limited number does not
#define PASS_HAS_BACK 2u    // dual: the back layer is blended too
#define PASS_COUNTS_ALL 4u  // instrumented, first pass: counts the fragments
#define PASS_COUNTS 8u      // instrumented: counts what is blended and missed

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer KeyBuffer { Key at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer WideKeyBuffer { uint64_t at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ColorBuffer { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HeadBuffer { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BackBuffer { BackFragment at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DrawBuffer { PassDraw at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterBuffer { PeelCounters c; };
#endif

struct PeelPush {
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(KeyBuffer) peeled;     // keys that this pass blends: one a pixel, front then back in dual
  ADDRESS_OF(KeyBuffer) next;       // keys that it finds, all 0 before
  ADDRESS_OF(ColorBuffer) front;    // one a pixel: what is accumulated, premultiplied
  ADDRESS_OF(ColorBuffer) back;     // one a pixel, behind what is still to be peeled (back=blend)
  ADDRESS_OF(HeadBuffer) heads;     // one a pixel, of the lists (back=list)
  ADDRESS_OF(BackBuffer) listed;    // their nodes
  ADDRESS_OF(DrawBuffer) draws;     // one a pass
  ADDRESS_OF(CounterBuffer) counters;
  uint capacity;  // of listed
  uint pass;      // 0 only finds
  uint asked;     // the pass of `draws` that asks for this one
  uint does;      // PASS_*
};

#ifdef __cplusplus
static_assert(sizeof(PassDraw) == 20);
}  // namespace oitlab::depth_peeling
#endif

#endif
