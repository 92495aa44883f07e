#version 460
// Sorts each pixel's list and blends it front to back, whatever its length: a bottom-up merge sort
// that relinks the nodes in place needs no local array, and so has no limit and nothing to overflow.
//
// The work of one dispatch is bounded all the same. Drivers stop dispatches that take seconds, and
// llvmpipe leaves a loop once an invocation has gone through 65,535 iterations, of all its loops
// together, without a word. A pixel that reaches the budget keeps its half-sorted list, and the next
// round goes on from there.
#include "common/bindings.glsl"
#include "common/order.glsl"
#include "reference/lists.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ListPush push; };

const uint iterationBudget = 60000u;  // below 65,535 by what the loops here do not count

shared uint groupDeepest;
shared uint groupCovered;
shared uint groupResolved;
shared uint groupUnfinished;

bool inFront(uint a, uint b) {
  return isInFront(push.nodes.at[a].depth, push.nodes.at[a].id, push.nodes.at[b].depth,
                   push.nodes.at[b].id);
}

// One level of the sort: merges neighbouring sorted runs of `run` nodes into runs of twice that.
// Returns the number of merges; 1 or less means that the list is sorted.
uint mergeRuns(inout uint head, uint run, inout uint iterations, out uint count) {
  uint rest = head, tail = LIST_END, merges = 0u;
  head = LIST_END;
  count = 0u;
  while (rest != LIST_END) {
    ++merges;
    uint a = rest, b = rest, countA = 0u, countB = run;
    while (countA < run && b != LIST_END) {
      ++countA;
      b = push.nodes.at[b].next;
    }
    iterations += countA + 1u;
    while (countA > 0u || (countB > 0u && b != LIST_END)) {
      const bool takeA = countA > 0u && (countB == 0u || b == LIST_END || !inFront(b, a));
      const uint node = takeA ? a : b;
      if (takeA) {
        a = push.nodes.at[a].next;
        --countA;
      } else {
        b = push.nodes.at[b].next;
        --countB;
      }
      if (tail == LIST_END) head = node;
      else push.nodes.at[tail].next = node;
      tail = node;
      ++count;
    }
    rest = b;
  }
  if (tail != LIST_END) push.nodes.at[tail].next = LIST_END;
  iterations += count;
  return merges;
}

// Goes on with a pixel's sort from runs of `run` nodes. True when the list is sorted; else `run` is
// where the next round begins.
bool sortWithinBudget(inout uint head, inout uint run) {
  uint iterations = 0u;
  for (;;) {
    uint count;
    if (mergeRuns(head, run, iterations, count) <= 1u) return true;
    run *= 2u;
    // Another level takes at most 2 iterations a node, the blending after it 1.
    if (iterations + 3u * count > iterationBudget) return false;
  }
}

void blendPixel(ivec2 pixel, uint node) {
  vec4 accumulated = vec4(0.0);
  uint count = 0u;
  for (; node != LIST_END; node = push.nodes.at[node].next) {
    accumulated = blendUnder(accumulated, push.nodes.at[node].color);
    ++count;
  }
  imageStore(target, pixel, overOpaque(accumulated, imageLoad(target, pixel)));
  atomicMax(groupDeepest, count);
  atomicAdd(groupResolved, count);
  atomicAdd(groupCovered, 1u);
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupDeepest = 0u;
    groupCovered = 0u;
    groupResolved = 0u;
    groupUnfinished = 0u;
  }
  barrier();

  const uvec2 pixel = gl_GlobalInvocationID.xy;
  // An overflowed capture is recorded again, and its half-built lists are not walked.
  const bool complete = push.counters.c.fragments <= push.capacity;
  if (all(lessThan(pixel, push.frame.c.size)) && complete) {
    const uint index = pixel.y * push.frame.c.size.x + pixel.x;
    uint head = push.heads.at[index];
    if (head != LIST_END) {
      uint run = push.round == 0u ? 1u : push.runs.at[index];
      if (sortWithinBudget(head, run)) {
        blendPixel(ivec2(pixel), head);
        head = LIST_END;  // done: later rounds pass it by
      } else {
        push.runs.at[index] = run;
        atomicAdd(groupUnfinished, 1u);
      }
      push.heads.at[index] = head;
    }
  }

  // One global update a workgroup: these counters are for the results, not for the image.
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupCovered + groupUnfinished > 0u) {
    atomicMax(push.counters.c.deepest, groupDeepest);
    atomicAdd(push.counters.c.coveredPixels, groupCovered);
    atomicAdd(push.counters.c.resolved, groupResolved);
    if (push.round + 1u == push.rounds) atomicAdd(push.counters.c.unfinished, groupUnfinished);
  }
}
