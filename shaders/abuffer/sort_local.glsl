// Sorts of the local array, front to back. MAX_FRAGMENTS is its length, ROUND_LENGTH that rounded up
// to a power of two. Up to SMALL_UP_TO fragments are sorted by SMALL_SORT, more by LARGE_SORT: a
// shader for an interval has one sort, the shader for all pixels chooses when it runs (section 4).
#ifndef OITLAB_ABUFFER_SORT_LOCAL_GLSL
#define OITLAB_ABUFFER_SORT_LOCAL_GLSL

#include "abuffer/entry.glsl"

#define HAS_SORT(sort) (SMALL_SORT == sort || LARGE_SORT == sort)

#if HAS_SORT(SORT_BITONIC)
Entry fragments[ROUND_LENGTH];
#else
Entry fragments[MAX_FRAGMENTS];
#endif

#if HAS_SORT(SORT_INSERTION)
// The inner loop is written out sixteenfold: n * n / 2 steps of a thousand fragments are more
// iterations than llvmpipe allows an invocation (65,535), a sixteenth of them are not.
#define STEP                                                       \
  if (hole == 0u || !isInFront(entry, fragments[hole - 1u])) break; \
  fragments[hole] = fragments[hole - 1u];                          \
  --hole;
#define STEPS STEP STEP STEP STEP
void sortByInsertion(uint count) {
  for (uint i = 1u; i < count; ++i) {
    const Entry entry = fragments[i];
    uint hole = i;
    for (;;) { STEPS STEPS STEPS STEPS }
    fragments[hole] = entry;
  }
}
#endif

#if HAS_SORT(SORT_SHELL)
// Ciura 2001, "Best Increments for the Average Case of Shellsort".
const uint gaps[8] = uint[](701u, 301u, 132u, 57u, 23u, 10u, 4u, 1u);
void sortByShell(uint count) {
  for (uint g = 0u; g < 8u; ++g) {
    const uint gap = gaps[g];
    for (uint i = gap; i < count; ++i) {
      const Entry entry = fragments[i];
      uint hole = i;
      for (; hole >= gap && isInFront(entry, fragments[hole - gap]); hole -= gap)
        fragments[hole] = fragments[hole - gap];
      fragments[hole] = entry;
    }
  }
}
#endif

#if HAS_SORT(SORT_MERGE)
// Bottom up; only the left one of two runs is moved out of the way, so that half of the array's
// length is enough to merge in.
Entry left[(ROUND_LENGTH + 1) / 2];
void sortByMerging(uint count) {
  for (uint run = 1u; run < count; run *= 2u)
    for (uint begin = 0u; begin + run < count; begin += 2u * run) {
      const uint end = min(begin + 2u * run, count);
      uint a = 0u, b = begin + run, to = begin;
      if (!isInFront(fragments[b], fragments[b - 1u])) continue;  // in order already
      for (uint i = 0u; i < run; ++i) left[i] = fragments[begin + i];
      while (a < run) {
        if (b < end && isInFront(fragments[b], left[a])) fragments[to++] = fragments[b++];
        else fragments[to++] = left[a++];
      }
    }
}
#endif

#if HAS_SORT(SORT_BITONIC)
// Batcher 1968, for as many entries as the next power of two; what is missing lies behind the rest.
void sortBitonic(uint count) {
  uint length = 1u;
  while (length < count) length *= 2u;
  for (uint i = count; i < length; ++i) fragments[i] = noEntry();
  for (uint run = 2u; run <= length; run *= 2u)
    for (uint distance = run / 2u; distance > 0u; distance /= 2u)
      for (uint i = 0u; i < length / 2u; ++i) {
        const uint a = 2u * i - (i & (distance - 1u)), b = a + distance;
        const bool ascending = (a & run) == 0u;
        const Entry first = fragments[a], second = fragments[b];
        if (ascending ? isInFront(second, first) : isInFront(first, second)) {
          fragments[a] = second;
          fragments[b] = first;
        }
      }
}
#endif

void sortBy(int sort, uint count) {
#if HAS_SORT(SORT_INSERTION)
  if (sort == SORT_INSERTION) sortByInsertion(count);
#endif
#if HAS_SORT(SORT_SHELL)
  if (sort == SORT_SHELL) sortByShell(count);
#endif
#if HAS_SORT(SORT_MERGE)
  if (sort == SORT_MERGE) sortByMerging(count);
#endif
#if HAS_SORT(SORT_BITONIC)
  if (sort == SORT_BITONIC) sortBitonic(count);
#endif
}

// Loads up to MAX_FRAGMENTS of the list at `node`, which is then the first that was left out, and
// returns how many.
uint loadFragments(inout uint node) {
  uint count = 0u;
  for (; node < push.capacity && count < uint(MAX_FRAGMENTS); node = push.nodes.at[node].next)
    fragments[count++] = entryOf(node);
  return count;
}

vec4 sortAndBlend(uint count) {
#if SMALL_SORT == LARGE_SORT
  sortBy(LARGE_SORT, count);
#else
  if (count <= uint(SMALL_UP_TO)) sortBy(SMALL_SORT, count);
  else sortBy(LARGE_SORT, count);
#endif
  vec4 accumulated = vec4(0.0);
  for (uint i = 0u; i < count; ++i) accumulated = blendUnder(accumulated, colorOf(fragments[i]));
  return accumulated;
}

#endif
