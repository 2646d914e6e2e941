#version 460
#extension GL_GOOGLE_include_directive : require
// The last step of the sort for GPUs, which has something to do only where there are crowds (crowds.glsl): a workgroup a stretch
// of the scene's numbers puts those of them that stand for one of a crowd into their crowd's places, in order.
#include "radix_carry.glsl"
#include "crowds.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(writeonly, 2, uint, order)
BUFFER(readonly, 3, uint, crowds)
BUFFER(readonly, 4, uint, crowd_members)

// Crowds that are told apart at once. One digit more stands for what is in none of them.
const uint CROWDS_AT_ONCE = DIGITS - 1u;
// Stretches whose counts an invocation waits for together.
const uint COUNTS_AT_ONCE = 8u;

// How many of a crowd have numbers in the stretches before.
uint before(uint stretch, uint crowd) {
    uint sum = 0u;
    for (uint first = 0u; first < stretch; first += COUNTS_AT_ONCE) {
        for (uint k = 0u; k < COUNTS_AT_ONCE; k++) {
            uint count = crowds.at[crowd_count_place(min(first + k, stretch - 1u), crowd)];
            sum += first + k < stretch ? count : 0u;
        }
    }
    return sum;
}

uint digit_of(uint number, uint first_crowd) {
    if (number >= FRAME.scene.gaussian_count || (crowds.at[crowd_bits_place(number)] >> number % 32u & 1u) == 0u) {
        return CROWDS_AT_ONCE;
    }
    // Those before the first turn over.
    return min(crowd_members.at[crowd_place(number)] - first_crowd, CROWDS_AT_ONCE);
}

void collect(uint first_number, uint first_crowd) {
    uint digits[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        digits[k] = digit_of(first_number + position_of(k), first_crowd);
    }
    sort_positions(digits);
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint i = k * RADIX_GROUP_SIZE + gl_LocalInvocationIndex;
        uint d = item_digit(items[i]);
        if (d < CROWDS_AT_ONCE) {
            order.at[offsets[d] + i - digit_begins[d]] = crowd_members.at[first_number + item_position(items[i])];
        }
    }
    barrier();
    advance(RADIX_PARTITION);
}

void main() {
    if (crowds.at[ANY_CROWD] == 0u) {
        return;
    }
    uint local = gl_LocalInvocationIndex;
    uint stretch = gl_WorkGroupID.x;
    uint first_number = stretch * stretch_size();
    uint end = min(first_number + stretch_size(), FRAME.scene.gaussian_count);
    uint crowd_count = KEY_COUNT / crowd_size(KEY_COUNT) + 1u;
    for (uint first_crowd = 0u; first_crowd < crowd_count; first_crowd += CROWDS_AT_ONCE) {
        uint crowd = first_crowd + local;
        bool is_crowd = local < CROWDS_AT_ONCE && crowd < min(crowd_count, MOST_CROWDS);
        uint own = is_crowd ? crowds.at[crowd_count_place(stretch, crowd)] : 0u;
        uint total;
        exclusive_sum(own, total);
        if (total == 0u) {
            continue; // none of these crowds is here
        }
        offsets[local] = own > 0u ? crowds.at[crowd_begin_place(crowd)] + before(stretch, crowd) : 0u;
        barrier();
        for (uint number = first_number; number < end; number += RADIX_PARTITION) {
            collect(number, first_crowd);
        }
    }
}
