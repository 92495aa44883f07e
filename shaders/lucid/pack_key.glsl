// Keys of tri-half-blocks as they are sorted.
#ifndef OITLAB_LUCID_PACK_KEY_GLSL
#define OITLAB_LUCID_PACK_KEY_GLSL

// Behind everything.
const uint padding = 0xffffffffu;

// Keys of fixed width, as the paper packs them (section 2, phase 2): the high bits hold the depth within the list's
// range, front first; the low bits hold the place in the list. Equal depths come out in any order, which the depth
// filter or the repair corrects.
//
// bits: number of bits that a place needs. depth: larger is nearer, within [low, high].
uint packKey(float depth, float low, float high, uint place, uint bits) {
  const float behind = high > low ? clamp((high - depth) / (high - low), 0.0, 1.0) : 0.0;
  const uint steps = (1u << (31u - bits)) - 1u;  // 31, not 32: always below padding
  return min(uint(behind * float(steps)), steps) << bits | place;
}

#endif
