// One pass of depth peeling (Everitt 2001; with DUAL from both ends, Bavoil and Myers 2008). A
// fragment whose key is the one that the pass before found for its pixel is blended; among those
// behind it (between both ends) the foremost (and the hindmost) is found for the next pass. So each
// layer is one geometry pass, and a fragment is shaded once, when it is blended.
//
// The papers find the nearest depth with the depth test, which keeps one of several fragments at the
// same depth: the rest are lost. The keys here order those by primitive id, so that each is a layer of
// its own. No two fragments of a pixel share a key: only one invocation of a pass blends to a pixel.
//
// STEP_TIES is for devices without 64-bit atomics. There a pass finds only the depth, the key's upper
// half, and a second one in between finds the lowest primitive id among the fragments of that depth.
#ifdef WIDE_ATOMICS
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "common/order.glsl"
#include "depth_peeling/peel_types.h"
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform Push { PeelPush push; };

// Each pass after the first runs if the one before it has found something.
bool passRuns() { return push.draws.at[push.asked].instanceCount != 0u; }

#ifdef DUAL
const uint keysPerPixel = 2u;
#else
const uint keysPerPixel = 1u;
#endif

uint64_t wide(Key key) { return packUint2x32(uvec2(key.low, key.high)); }
// Back keys are kept as complements, so that finding one is a maximum too, and 0 means none as well.
uint64_t fromBack(uint64_t key) { return ~key; }

void offer(uint slot, uint64_t key) {
  // Most fragments are behind one that was found already. Only halves are compared, since a half is
  // never seen half-written.
  const uint high = uint(key >> 32);
  if (high < push.next.at[slot].high) return;
#if defined(STEP_TIES)
  atomicMax(push.next.at[slot].low, uint(key));  // the upper half is found: this one has the same
#elif defined(WIDE_ATOMICS)
  atomicMax(WideKeyBuffer(push.next).at[slot], key);
#else
  atomicMax(push.next.at[slot].high, high);
#endif
}

// A fragment that is still to be peeled.
void find(uint slot, uint64_t key, bool counts) {
  if ((push.does & PASS_FINDS) == 0u) {
    if (counts) atomicAdd(push.counters.c.missed, 1u);
    return;
  }
  offer(slot, key);
#ifdef DUAL
  offer(slot + 1u, fromBack(key));
#endif
#ifndef STEP_TIES
  if (push.draws.at[push.pass + 1u].instanceCount == 0u)
    atomicOr(push.draws.at[push.pass + 1u].instanceCount, 1u);
#endif
}

void blendFront(uint pixel, vec4 color) {
  push.front.at[pixel] = blendUnder(push.front.at[pixel], color);
}

void blendBack(uint pixel, vec4 color) {
#ifdef BACK_LIST
  const uint index = atomicAdd(push.counters.c.back, 1u);
  if (index < push.capacity) {  // counted all the same: the host makes the list larger
    push.listed.at[index] = BackFragment(color, push.heads.at[pixel]);
    push.heads.at[pixel] = index;
  }
#else
  push.back.at[pixel] = vec4(color.rgb * color.a, color.a) + (1.0 - color.a) * push.back.at[pixel];
#endif
  if (push.counters.c.lastBackPass < push.pass) atomicMax(push.counters.c.lastBackPass, push.pass);
}

void fragment(Fragment f) {
  const uint pixel = f.index;
  const uint slot = pixel * keysPerPixel;
  const uint64_t key = wide(Key(~f.id, floatBitsToUint(f.depth)));
  const uint64_t front = wide(push.peeled.at[slot]);
  bool isFront = key == front, isBack = false;
  if (key > front) return;  // peeled before, or the pixel is done
#ifdef DUAL
  const uint64_t back = wide(push.peeled.at[slot + 1u]);
  if (fromBack(key) > back) return;
  isBack = !isFront && fromBack(key) == back && (push.does & PASS_HAS_BACK) != 0u;
#endif

  vec4 color;
#ifdef STEP_TIES
  const bool counts = false;
  if (isFront || isBack) return;
#else
  const bool counts = (push.does & PASS_COUNTS) != 0u;
#endif
  // Only a cutoff takes fragments away: those that are not blended now need no shade without one.
  const bool blends = isFront || isBack;
  if ((blends || hasCutoff(f)) && !shadeFragment(f, color)) return;
  if (counts) {
    if ((push.does & PASS_COUNTS_ALL) != 0u) atomicAdd(push.counters.c.fragments, 1u);
    if (blends) atomicAdd(push.counters.c.blended, 1u);
  }
  if (isFront) blendFront(pixel, color);
  else if (isBack) blendBack(pixel, color);
  else find(slot, key, counts);
}
