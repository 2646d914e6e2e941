// The masks of a block: a bit a Gaussian for each of several sets, from what a workgroup has found of each Gaussian. The includer
// says how many sets there are: SETS.
#ifndef RARA_SIDE_MASKS
#define RARA_SIDE_MASKS
#include "masks.glsl"

// GPUs put bits together by atomics; CPU drivers would carry those out one after the other.
layout(constant_id = 14) const bool ATOMIC_MASKS = false;

shared uint sets_of[ATOMIC_MASKS ? 1u : BLOCK_SIZE];
// The masks, each WORDS long.
shared uint set_masks[SETS * WORDS];

// The whole workgroup finds the masks; `sets` has a bit for each set that the invocation's Gaussian belongs to.
void find_masks(uint sets) {
    uint local = gl_LocalInvocationIndex;
    bool has_word = local < SETS * WORDS;
    if (ATOMIC_MASKS) {
        if (has_word) {
            set_masks[local] = 0u;
        }
        barrier();
        for (uint set = 0u; set < SETS; set++) {
            if ((sets >> set & 1u) != 0u) {
                // A union does not depend on the order of the atomics.
                atomicOr(set_masks[set * WORDS + (local >> 5)], 1u << (local & 31u));
            }
        }
    } else {
        sets_of[local] = sets;
        barrier();
        if (has_word) {
            uint mask = 0u;
            for (uint i = 0u; i < 32u; i++) {
                mask |= (sets_of[32u * (local % WORDS) + i] >> local / WORDS & 1u) << i;
            }
            set_masks[local] = mask;
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
