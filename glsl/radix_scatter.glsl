// The third step of a pass of the sort for GPUs: each partition carries its keys to their places. They are sorted by the digit
// first, so that neighbouring invocations write to neighbouring places.
#ifndef RARA_RADIX_SCATTER
#define RARA_RADIX_SCATTER
struct Params {
    uint pass; // of the sort, from 0
    uint macro_tiles; // how many there are, where one pass sorts the pairs by them; else 0
};
#define PARAMS Params
#include "radix_keys.glsl"
#include "radix_rank.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(readonly, 3, uint, order)
BUFFER(readonly, 4, uint, histogram)
BUFFER(writeonly, 5, uint, sorted_keys)
BUFFER(writeonly, 6, uint, sorted_order)
BUFFER(readonly, 7, uint, depth_keys)
// Where the pairs of each macro-tile begin, and where all end, which one pass finds on its way.
BUFFER(writeonly, 8, uint, macro_begins)

// The first pass of the splats' keys carries them from where they were found.
uint key_at(bool is_first, uint i) {
    return is_first ? depth_keys.at[i] : keys.at[i];
}

// Where a digit's keys of this partition go, less the place of the digit's first item.
shared uint offsets[DIGITS];

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    uint number = KEY_DIGIT;
    uint base = KEY_BASE;
    bool is_first = !PAIRS && number == 0u; // the splats are in their own order
    uvec2 bounds = partition_bounds(p, KEY_COUNT);
    uint total;
    uint of_digit = histogram.at[TOTAL_PLACE(local)];
    uint before = exclusive_sum(of_digit, total);
    if (PAIRS && p == 0u && local < push.params.macro_tiles) {
        macro_begins.at[local] = before;
        if (local + 1u == push.params.macro_tiles) {
            macro_begins.at[local + 1u] = before + of_digit;
        }
    }
    uint digits[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint i = bounds.x + position_of(k);
        uint d = digit(SORTED_BITS(key_at(is_first, min(i, bounds.y - 1u))) - base, number);
        // The positions beyond the last key take the last digit, and are left out below.
        digits[k] = i < bounds.y ? d : DIGITS - 1u;
    }
    sort_positions(digits);
    offsets[local] = before + histogram.at[COUNT_PLACE(local, p)] - digit_begins[local];
    barrier();
    for (uint first = local; first < bounds.y - bounds.x; first += KEYS_AT_ONCE * RADIX_GROUP_SIZE) {
        uint places[KEYS_AT_ONCE];
        uvec2 carried[KEYS_AT_ONCE]; // a key and what it orders
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            uint i = first + k * RADIX_GROUP_SIZE;
            uint item = items[i];
            places[k] = offsets[item_digit(item)] + i;
            uint source = min(bounds.x + item_position(item), bounds.y - 1u);
            carried[k] = uvec2(key_at(is_first, source), is_first ? source : order.at[source]);
        }
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            if (first + k * RADIX_GROUP_SIZE < bounds.y - bounds.x) {
                sorted_keys.at[places[k]] = carried[k].x;
                sorted_order.at[places[k]] = carried[k].y;
            }
        }
    }
}

#endif
