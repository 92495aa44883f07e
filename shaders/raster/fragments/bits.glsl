// Lanes and bits of coverage masks. The includer defines SUBGROUP_SIZE.
#ifndef OITLAB_RASTER_BITS_GLSL
#define OITLAB_RASTER_BITS_GLSL

// Lanes that take samples, and pixels that a team processes at the same time.
#define OWNERS min(SUBGROUP_SIZE, 32u)

// The number of the bit that has `n` set bits of the mask below it.
uint nthBit(uint mask, uint n) {
  uint place = 0u;
  [[unroll]] for (uint width = 16u; width > 0u; width /= 2u) {
    const uint below = bitCount(mask & ((1u << width) - 1u));
    const bool above = n >= below;
    n -= above ? below : 0u;
    mask = above ? mask >> width : mask;
    place += above ? width : 0u;
  }
  return place;
}

#endif
