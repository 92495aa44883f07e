// Radix sort of 32-bit keys with 32-bit values (harness/gpu/radix_sort.h). C++ and GLSL both include
// this.
#ifndef OITLAB_SORT_TYPES_H
#define OITLAB_SORT_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab {
#endif

// What every Vulkan device allows: workgroups of 128, 16 KiB of shared memory.
#define SORT_GROUP 128u
// Elements of an invocation and of a workgroup.
#define SORT_ITEMS 16u
#define SORT_BLOCK (SORT_GROUP * SORT_ITEMS)
// 4 bits a pass: a counter for each digit and invocation fits into shared memory.
#define SORT_DIGITS 16u
#define SORT_DIGIT_BITS 4u

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SortBuffer { uint at[]; };
#endif

struct SortPush {
  ADDRESS_OF(SortBuffer) keysIn;
  ADDRESS_OF(SortBuffer) valuesIn;
  ADDRESS_OF(SortBuffer) keysOut;
  ADDRESS_OF(SortBuffer) valuesOut;
  ADDRESS_OF(SortBuffer) counts;  // [digit][block]: elements; after the scan those in blocks before
  ADDRESS_OF(SortBuffer) totals;  // [digit]: elements
  uint count;   // elements
  uint blocks;  // of SORT_BLOCK elements
  uint shift;   // of the digit
};

#ifdef __cplusplus
}  // namespace oitlab
#endif

#endif
