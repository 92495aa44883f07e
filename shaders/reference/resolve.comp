#version 460
// Sorts each pixel's list and blends it front to back, whatever its length: a bottom-up merge sort
// that relinks the nodes in place needs no local array, and so has no limit and nothing to overflow.
#include "common/bindings.glsl"
#include "common/order.glsl"
#include "reference/lists.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ListPush push; };

shared uint groupDeepest;
shared uint groupCovered;

bool inFront(uint a, uint b) {
  return isInFront(push.nodes.at[a].depth, push.nodes.at[a].id, push.nodes.at[b].depth,
                   push.nodes.at[b].id);
}

// Merges neighbouring runs of `run` nodes, doubling `run` until one run holds the whole list.
uint sortList(uint head) {
  for (uint run = 1u;; run *= 2u) {
    uint rest = head, tail = LIST_END;
    uint merges = 0u;
    head = LIST_END;
    while (rest != LIST_END) {
      ++merges;
      uint a = rest, b = rest, countA = 0u, countB = run;
      while (countA < run && b != LIST_END) {
        ++countA;
        b = push.nodes.at[b].next;
      }
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
      }
      rest = b;
    }
    if (tail != LIST_END) push.nodes.at[tail].next = LIST_END;
    if (merges <= 1u) return head;
  }
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupDeepest = 0u;
    groupCovered = 0u;
  }
  barrier();

  const uvec2 pixel = gl_GlobalInvocationID.xy;
  // An overflowed capture is recorded again, and its half-built lists are not walked.
  const bool complete = push.counters.c.fragments <= push.capacity;
  if (all(lessThan(pixel, push.frame.c.size)) && complete) {
    uint node = push.heads.at[pixel.y * push.frame.c.size.x + pixel.x];
    if (node != LIST_END) {
      node = sortList(node);
      vec4 accumulated = vec4(0.0);
      uint count = 0u;
      for (; node != LIST_END; node = push.nodes.at[node].next) {
        accumulated = blendUnder(accumulated, push.nodes.at[node].color);
        ++count;
      }
      const ivec2 at = ivec2(pixel);
      imageStore(target, at, overOpaque(accumulated, imageLoad(target, at)));
      atomicMax(groupDeepest, count);
      atomicAdd(groupCovered, 1u);
    }
  }

  // One global update a workgroup: these counters are for the results, not for the image.
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupCovered > 0u) {
    atomicMax(push.counters.c.deepest, groupDeepest);
    atomicAdd(push.counters.c.coveredPixels, groupCovered);
  }
}
