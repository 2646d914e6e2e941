// The masks of a block: a bit a Gaussian for each of several sets, from what a workgroup has found of each Gaussian. The includer
// says how many sets there are: SETS.
#ifndef RARA_SIDE_MASKS
#define RARA_SIDE_MASKS
#include "masks.glsl"

layout(local_size_x_id = 14) in;
// Consecutive Gaussians of an invocation: one on GPUs, and on processors, whose workgroups are small, those of a mask's word.
const uint TURNS = BLOCK_SIZE / gl_WorkGroupSize.x;

// The masks, each WORDS long.
shared uint set_masks[SETS * WORDS];
// The bits of the invocation's own Gaussians, the first of which is the lowest bit.
uint own_bits[SETS];

// The Gaussian of the invocation's turn, in its block.
uint local_in_turn(uint turn) {
    return gl_LocalInvocationIndex * TURNS + turn;
}

// The whole workgroup begins empty masks.
void begin_masks() {
    for (uint set = 0u; set < SETS; set++) {
        own_bits[set] = 0u;
    }
    for (uint word = gl_LocalInvocationIndex; word < SETS * WORDS; word += gl_WorkGroupSize.x) {
        set_masks[word] = 0u;
    }
}

// `sets` has a bit for each set that the Gaussian of this turn belongs to.
void add_to_masks(uint turn, uint sets) {
    for (uint set = 0u; set < SETS; set++) {
        own_bits[set] |= (sets >> set & 1u) << turn;
    }
}

// The whole workgroup puts its bits together.
void end_masks() {
    barrier();
    uint first = local_in_turn(0u);
    for (uint set = 0u; set < SETS; set++) {
        if (own_bits[set] != 0u) {
            // A union does not depend on the order of the atomics.
            atomicOr(set_masks[set * WORDS + (first >> 5)], own_bits[set] << (first & 31u));
        }
    }
    barrier();
}

// How many of the block's Gaussians belong to a set.
uint set_count(uint set) {
    uint count = 0u;
    for (uint word = 0u; word < WORDS; word++) {
        count += uint(bitCount(set_masks[set * WORDS + word]));
    }
    return count;
}

#endif
