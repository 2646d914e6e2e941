// A bit for each Gaussian of a block.
#ifndef RARA_MASKS
#define RARA_MASKS
#include "frame.glsl"
#include "region/sides.glsl"

// Words of a block's mask.
const uint WORDS = BLOCK_SIZE / 32u;

// How many bits of a mask's word `place` stand before a Gaussian's.
uint bits_before(uint word, uint place, uint local) {
    return place < local >> 5 ? bitCount(word) : place == local >> 5 ? bitCount(word & ((1u << (local & 31u)) - 1u)) : 0u;
}

// A Gaussian's class by its words of the masks of what is visible and of what is cut.
uint side_of(uint visible, uint cut, uint local) {
    uint bit = 1u << (local & 31u);
    return (cut & bit) != 0u ? SIDE_CUTOFF : (visible & bit) != 0u ? SIDE_VISIBLE : SIDE_INVISIBLE;
}

#endif
