// Large ties: splats of one depth that are more than a partition of the sort holds. A first pipeline (radix_ties.comp) leaves each
// at its number in the scene, and a second one (radix_large_ties.comp) collects them from there in the order of the numbers, as in
// one pass of a sort by tie whose keys stand in that order already.
//
// A tie's number is its first place in the order over the least size of large ties, so that no two have the same one and
// nobody counts them. The scene's numbers are divided into stretches, each of which a workgroup collects.
#ifndef RARA_LARGE_TIES
#define RARA_LARGE_TIES
#include "radix.glsl"

// Large ties have more splats than this, of so many in all.
uint large_tie_size(uint splats) {
    return max(RADIX_PARTITION, (splats + MOST_LARGE_TIES - 1u) / MOST_LARGE_TIES);
}

// Numbers of a stretch: whole partitions, so many that there are no more stretches than MOST_STRETCHES.
uint stretch_size() {
    uint partitions = (CUT.scene.gaussian_count + RADIX_PARTITION - 1u) / RADIX_PARTITION;
    return RADIX_PARTITION * max(LEAST_STRETCH, (partitions + MOST_STRETCHES - 1u) / MOST_STRETCHES);
}

// The buffer `large_ties` holds whether there are any; the first place of each; how many splats of each every stretch has; and a
// bit for each number in the scene that stands for one of a tie.
const uint ANY_LARGE_TIE = 0u;

uint tie_begin_place(uint tie) {
    return 1u + tie;
}

uint tie_count_place(uint stretch, uint tie) {
    return 1u + (stretch + 1u) * MOST_LARGE_TIES + tie;
}

uint tie_bits_place(uint number) {
    uint stretches = (CUT.scene.gaussian_count + stretch_size() - 1u) / stretch_size();
    return 1u + (stretches + 1u) * MOST_LARGE_TIES + number / 32u;
}

// In `tie_members`: who has a number, and behind the splats' numbers of which tie it is one.
uint tie_place(uint number) {
    return 2u * CUT.scene.gaussian_count + number;
}

#endif
