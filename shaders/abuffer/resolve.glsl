// Sorts the fragments of a pixel in local memory and blends them (section 2, "sort and composite").
#ifndef OITLAB_ABUFFER_RESOLVE_GLSL
#define OITLAB_ABUFFER_RESOLVE_GLSL

#include "abuffer/deep_list.glsl"
#include "abuffer/finish.glsl"
#if LARGE_SORT == SORT_REGISTER
#include "abuffer/sort_register.glsl"
#else
#include "abuffer/sort_local.glsl"
#endif

// FIND_DEEP: the shader for all pixels finds those that are too deep itself; to an interval's none
// comes.
void resolvePixel(uint pixel) {
  const uint head = push.heads.at[pixel];
  if (head == LIST_END) return;
#if LARGE_SORT == SORT_REGISTER && defined(FIND_DEEP)
  // Loading relinks the list, so that depth must be known before.
  if (push.counts.at[pixel] > uint(MAX_FRAGMENTS)) {
    appendDeep(pixel);
    return;
  }
#endif
  uint rest = head;
  const uint count = loadFragments(rest);
#ifdef FIND_DEEP
  if (rest != LIST_END) {
    appendDeep(pixel);
    return;
  }
#endif
  const vec4 accumulated = sortAndBlend(count);
  uint leftOut = 0u;
  if (push.counting != 0u)
    for (const uint most = nodesInLists(); rest < most && leftOut <= most; ++leftOut)
      rest = push.nodes.at[rest].next;
  finishPixel(pixel, head, accumulated, Tally(count, leftOut));
}

#endif
