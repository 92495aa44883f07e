// The order of a list of at most SHORT_LIST, for the subgroup that blends it. The includer declares `push` with
// keys.
#ifndef OITLAB_LUCID_SHORT_LIST_GLSL
#define OITLAB_LUCID_SHORT_LIST_GLSL

#if SMALL_SUBGROUP
#include "lucid/sort.glsl"

uint placeMask;

void orderList(HalfBlock block) { placeMask = sortList(gl_SubgroupID * LIST, block); }

// Place in the list of the i-th tri-half-block from the front; i = n * SUBGROUP_SIZE + lane.
uint placeOf(HalfBlock block, uint i) { return keys[gl_SubgroupID * LIST + i] & placeMask; }

#else
#define SORT_KEYS 1
#include "lucid/register_sort.glsl"
#define SORT_KEYS 2
#include "lucid/register_sort.glsl"

uint firstPlace, secondPlace;  // of ranks lane and SUBGROUP_SIZE + lane

void orderList(HalfBlock block) {
  if (block.count <= SUBGROUP_SIZE) {
    uint keys[1];
    const uint placeMask = sortInRegisters(block, keys);
    firstPlace = keys[0] & placeMask;
  } else {
    uint keys[2];
    const uint placeMask = sortInRegisters(block, keys), lane = gl_SubgroupInvocationID, half_ = SUBGROUP_SIZE / 2u;
    const uint even0 = subgroupShuffle(keys[0], lane / 2u), odd0 = subgroupShuffle(keys[1], lane / 2u);
    const uint even1 = subgroupShuffle(keys[0], half_ + lane / 2u), odd1 = subgroupShuffle(keys[1], half_ + lane / 2u);
    firstPlace = ((lane & 1u) == 0u ? even0 : odd0) & placeMask;
    secondPlace = ((lane & 1u) == 0u ? even1 : odd1) & placeMask;
  }
}

uint placeOf(HalfBlock block, uint i) { return i < SUBGROUP_SIZE ? firstPlace : secondPlace; }
#endif

// Replaces the depths by the order, for low raster.
void storeOrder(HalfBlock block) {
  for (uint i = gl_SubgroupInvocationID; i < block.count; i += SUBGROUP_SIZE)
    push.keys.at[block.first + i] = placeOf(block, i);
}

#endif
