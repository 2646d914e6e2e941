// A bit for each Gaussian of a block.
#ifndef RARA_MASKS
#define RARA_MASKS
#include "frame.glsl"
#include "region/sides.glsl"

// Words of a block's mask.
const uint WORDS = BLOCK_SIZE / 32u;

// How many bits of a mask's word number `place` stand before the bit of a block's Gaussian.
uint bits_before(uint word, uint place, uint local) {
    return place < local >> 5 ? bitCount(word) : place == local >> 5 ? bitCount(word & ((1u << (local & 31u)) - 1u)) : 0u;
}

// A Gaussian's side, from its words of the two masks of what is visible and of what is cut.
uint side_of(uint visible, uint cut, uint local) {
    uint bit = 1u << (local & 31u);
    return (cut & bit) != 0u ? SIDE_CUTOFF : (visible & bit) != 0u ? SIDE_VISIBLE : SIDE_INVISIBLE;
}

#endif
