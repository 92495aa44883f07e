// Sorts a linked list whatever its length: a bottom-up merge sort that relinks the nodes in place
// needs no local array, and so has no limit and nothing to overflow.
//
// The work of one dispatch is bounded all the same. Drivers stop dispatches that take seconds, and
// llvmpipe leaves a loop once an invocation has gone through 65,535 iterations, of all its loops
// together, without a word. A list that reaches the budget stays half sorted, and the next dispatch
// goes on from there.
#ifndef OITLAB_LIST_SORT_GLSL
#define OITLAB_LIST_SORT_GLSL

#include "common/lists.h"
#include "common/order.glsl"

const uint iterationBudget = 60000u;  // below 65,535 by what the loops here do not count

// One level of the sort: merges neighbouring sorted runs of `run` nodes into runs of twice that.
// Returns the number of merges; 1 or less means that the list is sorted. `nodeCount`: nodes that there
// are; a list that is not one (lists.h) is empty afterwards.
uint mergeRuns(NodeBuffer nodes, uint nodeCount, inout uint head, uint run, inout uint iterations,
               out uint count) {
  uint rest = head, tail = LIST_END, merges = 0u;
  head = LIST_END;
  count = 0u;
  while (rest < nodeCount && count <= nodeCount) {
    ++merges;
    uint a = rest, b = rest, countA = 0u, countB = run;
    while (countA < run && b < nodeCount) {
      ++countA;
      b = nodes.at[b].next;
    }
    iterations += countA + 1u;
    while (countA > 0u || (countB > 0u && b < nodeCount)) {
      const bool takeA =
          countA > 0u && (countB == 0u || b >= nodeCount ||
                          !isInFront(nodes.at[b].depth, nodes.at[b].id, nodes.at[a].depth,
                                     nodes.at[a].id));
      const uint node = takeA ? a : b;
      if (takeA) {
        a = nodes.at[a].next;
        --countA;
      } else {
        b = nodes.at[b].next;
        --countB;
      }
      if (tail == LIST_END) head = node;
      else nodes.at[tail].next = node;
      tail = node;
      ++count;
    }
    rest = b;
  }
  if (tail != LIST_END) nodes.at[tail].next = LIST_END;
  iterations += count;
  if (rest == LIST_END) return merges;
  head = LIST_END;
  return 0u;
}

// Goes on with a list's sort from runs of `run` nodes (1 at the start), of `nodeCount` that there are.
// True when the list is sorted; else `run` is where the next dispatch begins. A list that is not one
// comes back empty: its fragments are then missing in what the methods count.
bool sortWithinBudget(NodeBuffer nodes, uint nodeCount, inout uint head, inout uint run) {
  uint iterations = 0u;
  for (;;) {
    uint count;
    if (mergeRuns(nodes, nodeCount, head, run, iterations, count) <= 1u) return true;
    run *= 2u;
    // Another level takes at most 2 iterations a node, the blending after it 1.
    if (iterations + 3u * count > iterationBudget) return false;
  }
}

#endif
