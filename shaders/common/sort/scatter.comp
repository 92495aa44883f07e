#version 460
// Moves a block's elements to their places by the digit. Each invocation has consecutive elements, and
// they keep their order: the sort is stable.
#include "common/sort/group_scan.glsl"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { SortPush push; };

// [digit][invocation], with a gap after every SORT_ITEMS, so that the scan below, where an invocation
// goes through SORT_ITEMS neighbours, finds different banks.
const uint counters = SORT_DIGITS * SORT_GROUP;
shared uint placed[counters + counters / SORT_ITEMS];
uint at(uint i) { return i + i / SORT_ITEMS; }

shared uint digitStart[SORT_DIGITS];  // where this block's elements of a digit go

void main() {
  const uint thread = gl_LocalInvocationIndex;
  const uint block = gl_WorkGroupID.x;
  const uint start = block * SORT_BLOCK + thread * SORT_ITEMS;
  const uint end = min(start + SORT_ITEMS, push.count);

  for (uint digit = 0u; digit < SORT_DIGITS; ++digit) placed[at(digit * SORT_GROUP + thread)] = 0u;
  uint digits[SORT_ITEMS];
  for (uint element = start; element < end; ++element) {
    const uint digit = push.keysIn.at[element] >> push.shift & (SORT_DIGITS - 1u);
    digits[element - start] = digit;
    ++placed[at(digit * SORT_GROUP + thread)];
  }
  barrier();

  // Counters to the number of elements before, in the order of digit, then invocation.
  const uint first = thread * SORT_ITEMS;  // as many counters an invocation as it has elements
  uint sum = 0u;
  for (uint i = first; i < first + SORT_ITEMS; ++i) sum += placed[at(i)];
  uint total;
  uint running = exclusiveSum(sum, total);
  for (uint i = first; i < first + SORT_ITEMS; ++i) {
    const uint count = placed[at(i)];
    placed[at(i)] = running;
    running += count;
  }
  barrier();
  if (thread < SORT_DIGITS) {
    uint smaller = 0u;  // elements of smaller digits, of all blocks
    for (uint digit = 0u; digit < thread; ++digit) smaller += push.totals.at[digit];
    // Less what the scan counted of smaller digits in this block. It may wrap below 0, and back.
    digitStart[thread] = smaller + push.counts.at[thread * push.blocks + block] -
                         placed[at(thread * SORT_GROUP)];
  }
  barrier();

  for (uint element = start; element < end; ++element) {
    const uint digit = digits[element - start];
    const uint place = digitStart[digit] + placed[at(digit * SORT_GROUP + thread)]++;
    push.keysOut.at[place] = push.keysIn.at[element];
    push.valuesOut.at[place] = push.valuesIn.at[element];
  }
}
