#version 460
#extension GL_GOOGLE_include_directive : require
// The last step of the sort for GPUs, which has something to do only where there are large ties (large_ties.glsl): a workgroup a stretch
// of the scene's numbers puts those of them that stand for one of a tie into their tie's places, in order.
#include "radix_carry.glsl"
#include "large_ties.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(writeonly, 2, uint, order)
BUFFER(readonly, 3, uint, large_ties)
BUFFER(readonly, 4, uint, tie_members)

// Large ties that are told apart at once. One digit more stands for what is in none of them.
const uint TIES_AT_ONCE = DIGITS - 1u;
// Stretches whose counts an invocation waits for together.
const uint COUNTS_AT_ONCE = 8u;

// How many of a tie have numbers in the stretches before.
uint before(uint stretch, uint tie) {
    uint sum = 0u;
    for (uint first = 0u; first < stretch; first += COUNTS_AT_ONCE) {
        for (uint k = 0u; k < COUNTS_AT_ONCE; k++) {
            uint count = large_ties.at[tie_count_place(min(first + k, stretch - 1u), tie)];
            sum += first + k < stretch ? count : 0u;
        }
    }
    return sum;
}

uint digit_of(uint number, uint first_tie) {
    if (number >= CUT.scene.gaussian_count || (large_ties.at[tie_bits_place(number)] >> number % 32u & 1u) == 0u) {
        return TIES_AT_ONCE;
    }
    // Those before the first turn over.
    return min(tie_members.at[tie_place(number)] - first_tie, TIES_AT_ONCE);
}

void collect(uint first_number, uint first_tie) {
    uint digits[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        digits[k] = digit_of(first_number + position_of(k), first_tie);
    }
    sort_positions(digits);
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint i = k * RADIX_GROUP_SIZE + gl_LocalInvocationIndex;
        uint d = item_digit(items[i]);
        if (d < TIES_AT_ONCE) {
            order.at[offsets[d] + i - digit_begins[d]] = tie_members.at[first_number + item_position(items[i])];
        }
    }
    barrier();
    advance(RADIX_PARTITION);
}

void main() {
    if (large_ties.at[ANY_LARGE_TIE] == 0u) {
        return;
    }
    uint local = gl_LocalInvocationIndex;
    uint stretch = gl_WorkGroupID.x;
    uint first_number = stretch * stretch_size();
    uint end = min(first_number + stretch_size(), CUT.scene.gaussian_count);
    uint tie_count = KEY_COUNT / large_tie_size(KEY_COUNT) + 1u;
    for (uint first_tie = 0u; first_tie < tie_count; first_tie += TIES_AT_ONCE) {
        uint tie = first_tie + local;
        bool is_tie = local < TIES_AT_ONCE && tie < min(tie_count, MOST_LARGE_TIES);
        uint own = is_tie ? large_ties.at[tie_count_place(stretch, tie)] : 0u;
        uint total;
        exclusive_sum(own, total);
        if (total == 0u) {
            continue; // none of these large ties is here
        }
        offsets[local] = own > 0u ? large_ties.at[tie_begin_place(tie)] + before(stretch, tie) : 0u;
        barrier();
        for (uint number = first_number; number < end; number += RADIX_PARTITION) {
            collect(number, first_tie);
        }
    }
}
