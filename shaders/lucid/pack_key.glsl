// Keys of tri-half-blocks as they are sorted.
#ifndef OITLAB_LUCID_PACK_KEY_GLSL
#define OITLAB_LUCID_PACK_KEY_GLSL

// Behind everything.
const uint padding = 0xffffffffu;

// Keys of fixed width: the depth within the list's range in the high bits, front first, and the place
// in the list in the low ones, as the paper packs them (section 2, phase 2). Equal depths come out in
// any order: the depth filter puts these right, or the repair.
//
// bits: that the places need. depths: larger is nearer, within [low, high].
uint packKey(float depth, float low, float high, uint place, uint bits) {
  const float behind = high > low ? clamp((high - depth) / (high - low), 0.0, 1.0) : 0.0;
  const uint steps = (1u << (31u - bits)) - 1u;  // 31, not 32: below `padding` in any case
  return min(uint(behind * float(steps)), steps) << bits | place;
}

#endif
