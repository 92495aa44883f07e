// Places in a half-block.
#ifndef OITLAB_RASTER_HALF_BLOCK_GLSL
#define OITLAB_RASTER_HALF_BLOCK_GLSL

#include "raster/blocks/block_types.h"

// The pixel of the frame at the upper left of half-block `number` of a frame of that size.
ivec2 cornerOf(uint number, uvec2 size) {
  const uint columns = (size.x + BIN_SIZE - 1u) / BIN_SIZE;
  const uint bin = number / HALF_BLOCKS, inBin = number % HALF_BLOCKS;
  return ivec2(uvec2(bin % columns, bin / columns) * BIN_SIZE +
               uvec2(inBin % HALF_BLOCKS_ACROSS * HALF_BLOCK_WIDTH,
                     inBin / HALF_BLOCKS_ACROSS * HALF_BLOCK_HEIGHT));
}

TriHalfBlock itemAt(TriHalfBlockBuffer list, uint place) {
  const uvec2 words = list.at[place];
  return TriHalfBlock(words.x, words.y);
}

// Of a bit of a coverage mask.
uvec2 pixelOf(uint bit) { return uvec2(bit % HALF_BLOCK_WIDTH, bit / HALF_BLOCK_WIDTH); }

#endif
