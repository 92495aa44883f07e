// The idea of Knowles, Leach and Zambetta 2014 ("Fast Sorting for Exact OIT of Complex Scenes"):
// blocks of fragments are sorted in registers, and go back to the list's own memory as sorted chains;
// blending merges the chains from there. All that is indexed at run time is one entry a chain.
#ifndef OITLAB_ABUFFER_SORT_REGISTER_GLSL
#define OITLAB_ABUFFER_SORT_REGISTER_GLSL

#include "abuffer/entry.glsl"

// Blocks of 32, which take 64 registers; smaller ones where no pixel fills them.
#if MAX_FRAGMENTS <= 8
#define BLOCK 8
#elif MAX_FRAGMENTS <= 16
#define BLOCK 16
#else
#define BLOCK 32
#endif
#define BLOCKS ((MAX_FRAGMENTS + BLOCK - 1) / BLOCK)

// Batcher's odd-even merge sort as a network: indices are constants, so that the block is never in
// memory. Loops would leave it to the compiler to find that out.
#define S(a, b)                       \
  if (isInFront(block[b], block[a])) { \
    const Entry moved = block[a];     \
    block[a] = block[b];              \
    block[b] = moved;                 \
  }
#define S2(a, d) S(a, a + d) S(a + 1, a + 1 + d)
#define S4(a, d) S2(a, d) S2(a + 2, d)
#define S8(a, d) S4(a, d) S4(a + 4, d)
#define SORT4(a) S(a, a + 1) S(a + 2, a + 3) S2(a, 2) S(a + 1, a + 2)
#define SORT8(a) \
  SORT4(a) SORT4(a + 4) S4(a, 4) S2(a + 2, 2) S(a + 1, a + 2) S(a + 3, a + 4) S(a + 5, a + 6)
#define LAST16(a) \
  S(a + 1, a + 2) S(a + 3, a + 4) S(a + 5, a + 6) S(a + 7, a + 8) S(a + 9, a + 10) S(a + 11, a + 12) \
  S(a + 13, a + 14)
#define SORT16(a) \
  SORT8(a) SORT8(a + 8) S8(a, 8) S4(a + 4, 4) S2(a + 2, 2) S2(a + 6, 2) S2(a + 10, 2) LAST16(a)
#define SORT32 \
  SORT16(0) SORT16(16) S8(0, 16) S8(8, 16) S8(8, 8) S4(4, 4) S4(12, 4) S4(20, 4) \
  S2(2, 2) S2(6, 2) S2(10, 2) S2(14, 2) S2(18, 2) S2(22, 2) S2(26, 2) \
  LAST16(0) S(15, 16) LAST16(16)
#define FOR8(DO, a) DO(a) DO(a + 1) DO(a + 2) DO(a + 3) DO(a + 4) DO(a + 5) DO(a + 6) DO(a + 7)
#if BLOCK == 8
#define NETWORK SORT8(0)
#define FOR_BLOCK(DO) FOR8(DO, 0)
#elif BLOCK == 16
#define NETWORK SORT16(0)
#define FOR_BLOCK(DO) FOR8(DO, 0) FOR8(DO, 8)
#else
#define NETWORK SORT32
#define FOR_BLOCK(DO) FOR8(DO, 0) FOR8(DO, 8) FOR8(DO, 16) FOR8(DO, 24)
#endif

Entry chains[BLOCKS];  // the foremost fragment of each that is not blended yet
uint chainCount = 0u;

// Sorts the next BLOCK nodes into a chain and returns its first; `node` is then the next block's.
Entry sortBlock(inout uint node, inout uint count) {
  Entry block[BLOCK];
#define LOAD(i)                                              \
  block[i] = noEntry();                                      \
  if (node < push.capacity && count < uint(MAX_FRAGMENTS)) { \
    block[i] = entryOf(node);                                \
    node = push.nodes.at[node].next;                         \
    ++count;                                                 \
  }
  FOR_BLOCK(LOAD)
  NETWORK
  // Empty places are the last ones, and their node is LIST_END: the end of the chain.
#define LINK(i)                  \
  if (block[i].node != LIST_END) \
    push.nodes.at[block[i].node].next = i + 1 < BLOCK ? block[min(i + 1, BLOCK - 1)].node : LIST_END;
  FOR_BLOCK(LINK)
  return block[0];
}

// These two as in sort_local.glsl.
uint loadFragments(inout uint node) {
  uint count = 0u;
  while (node < push.capacity && count < uint(MAX_FRAGMENTS))
    chains[chainCount++] = sortBlock(node, count);
  return count;
}

// A helper invocation's links were not stored, so that its chains may end early.
vec4 sortAndBlend(uint count) {
  vec4 accumulated = vec4(0.0);
  for (uint i = 0u; i < count; ++i) {
    uint best = 0u;
    Entry front = chains[0];
    for (uint chain = 1u; chain < chainCount; ++chain) {
      const Entry other = chains[chain];
      if (isInFront(other, front)) {
        front = other;
        best = chain;
      }
    }
    if (front.node == LIST_END) break;
    const uint next = push.nodes.at[front.node].next;
    if (next < push.capacity) chains[best] = entryOf(next);
    else chains[best] = noEntry();
    accumulated = blendUnder(accumulated, colorOf(front));
  }
  return accumulated;
}

#endif
