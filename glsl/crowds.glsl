// Crowds: survivors of one depth that are more than a partition of the sort holds. A first kernel (radix_ties.comp) leaves each
// at its number in the scene, and a second one (radix_crowds.comp) collects them from there in the order of the numbers, as in
// one pass of a sort by crowd whose keys stand in that order already.
//
// A crowd's number is its first place in the order over the least size of crowds, so that no two have the same one and
// nobody counts them. The scene's numbers are divided into stretches, each of which a workgroup collects.
#ifndef RARA_CROWDS
#define RARA_CROWDS
#include "radix.glsl"

// Crowds have more survivors than this, of so many in all.
uint crowd_size(uint survivors) {
    return max(RADIX_PARTITION, (survivors + MOST_CROWDS - 1u) / MOST_CROWDS);
}

// Numbers of a stretch: whole partitions, so many that there are no more stretches than MOST_STRETCHES.
uint stretch_size() {
    uint partitions = (FRAME.scene.gaussian_count + RADIX_PARTITION - 1u) / RADIX_PARTITION;
    return RADIX_PARTITION * max(LEAST_STRETCH, (partitions + MOST_STRETCHES - 1u) / MOST_STRETCHES);
}

// The buffer `crowds` holds whether there are any; the first place of each; how many survivors of each every stretch has; and a
// bit for each number in the scene that stands for one of a crowd.
const uint ANY_CROWD = 0u;

uint crowd_begin_place(uint crowd) {
    return 1u + crowd;
}

uint crowd_count_place(uint stretch, uint crowd) {
    return 1u + (stretch + 1u) * MOST_CROWDS + crowd;
}

uint crowd_bits_place(uint number) {
    uint stretches = (FRAME.scene.gaussian_count + stretch_size() - 1u) / stretch_size();
    return 1u + (stretches + 1u) * MOST_CROWDS + number / 32u;
}

// In `crowd_members`: who has a number, and behind room for all of them of which crowd it is one.
uint crowd_place(uint number) {
    return FRAME.scene.gaussian_count + number;
}

#endif
