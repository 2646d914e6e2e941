#version 460
#extension GL_GOOGLE_include_directive : require
// After the sort for GPUs, splats of one depth are in the order of the blocks; this puts them into that of their numbers. An
// invocation orders a few alone. Where more have one depth, the workgroup of the first ranks them, or sorts them by the digits
// in which their numbers differ. Of large ties, each workgroup sends its own to their numbers (large_ties.glsl).
#include "radix_carry.glsl"
#include "large_ties.glsl"
#include "splat_gaussians.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(coherent, 3, uint, order)
BUFFER(coherent, 4, uint, scratch)
BUFFER(readonly, 5, uint, depth_keys)
BUFFER(, 6, uint, large_ties)
// The buffer of the depth keys, but for the splats' numbers.
BUFFER(writeonly, 7, uint, tie_members)
#define STEPS RADIX_KEYS
#include "ties.glsl"

uint number(uint splat_index) {
    return depth_keys.at[number_place(splat_index)];
}

// Most that an invocation orders alone: its numbers have room in its part of `items`.
const uint FEW = RADIX_PARTITION / RADIX_GROUP_SIZE;

// The first of each many that begin in this partition.
shared uint begins[RADIX_PARTITION / FEW];
shared uint begin_count;

const uvec2 NO_LARGE_TIE = uvec2(~0u, 0u);

// The places [first, last) of the keys that equal the one at a place.
uvec2 equal_keys(uint place) {
    uint count = KEY_COUNT;
    uint key = keys.at[place];
    // The first key that is not below it is in [below.x, below.y], the first one above it in [above.x, above.y].
    uvec2 below = uvec2(0u, place);
    uvec2 above = uvec2(place + 1u, count);
    while (below.x < below.y || above.x < above.y) {
        uvec2 middle = uvec2((below.x + below.y) / 2u, (above.x + above.y) / 2u);
        uvec2 there = uvec2(keys.at[middle.x], keys.at[min(middle.y, count - 1u)]);
        if (below.x < below.y) {
            below = there.x < key ? uvec2(middle.x + 1u, below.y) : uvec2(below.x, middle.x);
        }
        if (above.x < above.y) {
            above = there.y <= key ? uvec2(middle.y + 1u, above.y) : uvec2(above.x, middle.y);
        }
    }
    return uvec2(below.x, above.x);
}

// The tie at a place. It holds half a partition before the place or behind it, which rules out nearly all.
uvec2 tie_at(uint place) {
    const uint HALF_PARTITION = RADIX_PARTITION / 2u;
    uint key = keys.at[place];
    bool before = place >= HALF_PARTITION && keys.at[max(place, HALF_PARTITION) - HALF_PARTITION] == key;
    bool behind = place + HALF_PARTITION < KEY_COUNT && keys.at[min(place + HALF_PARTITION, KEY_COUNT - 1u)] == key;
    if (!before && !behind) {
        return NO_LARGE_TIE;
    }
    uvec2 places = equal_keys(place);
    return places.y - places.x > large_tie_size(KEY_COUNT) ? places : NO_LARGE_TIE;
}

// Sends those of a tie that are in this partition to their numbers.
void send(uvec2 tie, uvec2 bounds) {
    uint local = gl_LocalInvocationIndex;
    uint tie_number = tie.x / large_tie_size(KEY_COUNT);
    uvec2 own = uvec2(max(tie.x, bounds.x), min(tie.y, bounds.y));
    uint members[RADIX_KEYS];
    uint its_numbers[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        members[k] = order.at[min(own.x + k * RADIX_GROUP_SIZE + local, own.y - 1u)];
        its_numbers[k] = number(members[k]);
    }
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        if (own.x + k * RADIX_GROUP_SIZE + local < own.y) {
            uint its_number = its_numbers[k];
            tie_members.at[its_number] = members[k];
            tie_members.at[tie_place(its_number)] = tie_number;
            // Neither bits nor sums depend on the order.
            atomicOr(large_ties.at[tie_bits_place(its_number)], 1u << its_number % 32u);
            atomicAdd(large_ties.at[tie_count_place(its_number / stretch_size(), tie_number)], 1u);
        }
    }
    if (local == 0u && tie.x >= bounds.x) {
        large_ties.at[tie_begin_place(tie_number)] = tie.x;
        large_ties.at[ANY_LARGE_TIE] = 1u; // whoever writes it
    }
}

// One past the last key that equals the one at `begin`, of as many as an invocation orders alone; beyond it, of more.
uint end_of_few(uint begin) {
    uint count = KEY_COUNT;
    uint key = keys.at[begin];
    uint size = 2u;
    bool same = true;
    while (same && size <= FEW) {
        uint first = begin + size;
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            uint here = keys.at[min(first + k, count - 1u)];
            same = same && first + k < count && here == key;
            size += same ? 1u : 0u;
        }
    }
    return begin + size;
}

// The place in shared memory of one of the numbers that an invocation orders alone.
uint few_place(uint k) {
    return k * RADIX_GROUP_SIZE + gl_LocalInvocationIndex;
}

void order_alone(uint begin, uint end) {
    uint size = end - begin;
    uint own[KEYS_AT_ONCE];
    uint its_numbers[KEYS_AT_ONCE];
    for (uint first = 0u; first < size; first += KEYS_AT_ONCE) {
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            own[k] = order.at[min(begin + first + k, end - 1u)];
            its_numbers[k] = number(own[k]);
        }
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            // Those beyond the end write the last one once more.
            uint place = min(first + k, size - 1u);
            scratch.at[begin + place] = own[k];
            items[few_place(place)] = its_numbers[k];
        }
    }
    for (uint first = 0u; first < size; first += KEYS_AT_ONCE) {
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            own[k] = scratch.at[min(begin + first + k, end - 1u)];
        }
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            uint its_number = items[few_place(min(first + k, size - 1u))];
            uint rank = 0u;
            for (uint other = 0u; other < size; other++) {
                rank += items[few_place(other)] < its_number ? 1u : 0u;
            }
            order.at[begin + rank] = own[k];
        }
    }
}

// Does so partition by partition, each as in a pass of the sort.
void sort_by_digit(bool second, uint begin, uint end, uint digit_number) {
    uint local = gl_LocalInvocationIndex;
    offsets[local] = 0u;
    barrier();
    for (uint first = begin; first < end; first += RADIX_PARTITION) {
        for (uint k = 0u; k < RADIX_KEYS; k++) {
            uint i = first + k * RADIX_GROUP_SIZE + local;
            if (i < end) {
                atomicAdd(offsets[digit(number(at(second, i)), digit_number)], 1u);
            }
        }
    }
    barrier();
    uint total;
    uint before = exclusive_sum(offsets[local], total);
    offsets[local] = begin + before;
    for (uint first = begin; first < end; first += RADIX_PARTITION) {
        uint count = min(end - first, RADIX_PARTITION);
        uint digits[RADIX_KEYS];
        for (uint k = 0u; k < RADIX_KEYS; k++) {
            uint position = position_of(k);
            digits[k] = position < count ? digit(number(at(second, first + position)), digit_number) : DIGITS - 1u;
        }
        sort_positions(digits);
        uint own[RADIX_KEYS];
        for (uint k = 0u; k < RADIX_KEYS; k++) {
            uint i = min(k * RADIX_GROUP_SIZE + local, count - 1u);
            own[k] = at(second, first + item_position(items[i]));
        }
        for (uint k = 0u; k < RADIX_KEYS; k++) {
            uint i = k * RADIX_GROUP_SIZE + local;
            if (i < count) {
                uint d = item_digit(items[i]);
                put(!second, offsets[d] + i - digit_begins[d], own[k]);
            }
        }
        barrier();
        advance(count);
    }
    publish();
}

// Orders as many as there are invocations: each counts those that belong before its own.
void rank_together(uint begin, uint end) {
    uint local = gl_LocalInvocationIndex;
    uint count = end - begin;
    uint splat_index = local < count ? order.at[begin + local] : 0u;
    uint its_number = local < count ? number(splat_index) : 0u;
    items[local] = its_number;
    barrier();
    uint rank = 0u;
    for (uint other = 0u; other < count; other++) {
        rank += items[other] < its_number ? 1u : 0u;
    }
    if (local < count) {
        order.at[begin + rank] = splat_index;
    }
    publish();
}

// Which of an invocation's keys are the first of several that are equal, a bit each.
uint find_firsts(uvec2 bounds, uint count) {
    uint firsts = 0u;
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint i = bounds.x + k * RADIX_GROUP_SIZE + gl_LocalInvocationIndex;
        uint here = min(i, count - 1u);
        uint key = keys.at[here];
        bool is_first = here == 0u || keys.at[max(here, 1u) - 1u] != key;
        bool is_followed = i + 1u < count && keys.at[min(here + 1u, count - 1u)] == key;
        firsts |= i < bounds.y && is_first && is_followed ? 1u << k : 0u;
    }
    return firsts;
}

void main() {
    uint count = KEY_COUNT;
    uvec2 bounds = partition_bounds(gl_WorkGroupID.x, count);
    if (gl_LocalInvocationIndex == 0u) {
        begin_count = 0u;
    }
    barrier();
    // A tie holds more than a partition: it holds the first or the last of those that it is in.
    uvec2 ties_here[2];
    for (uint end = 0u; end < 2u; end++) {
        ties_here[end] = tie_at(end == 0u ? bounds.x : bounds.y - 1u);
    }
    for (uint firsts = find_firsts(bounds, count); firsts != 0u; firsts &= firsts - 1u) {
        uint begin = bounds.x + uint(findLSB(firsts)) * RADIX_GROUP_SIZE + gl_LocalInvocationIndex;
        if (begin == ties_here[1].x) {
            continue;
        }
        uint end = end_of_few(begin);
        if (end - begin <= FEW) {
            order_alone(begin, end);
        } else {
            begins[atomicAdd(begin_count, 1u)] = begin; // in any order: they are sorted each by itself
        }
    }
    barrier();
    for (uint tie = 0u; tie < begin_count; tie++) {
        uvec2 places = equal_keys(begins[tie]);
        if (places.y - places.x <= RADIX_GROUP_SIZE) {
            rank_together(places.x, places.y);
        } else {
            sort_together(places.x, places.y);
        }
    }
    for (uint end = 0u; end < 2u; end++) {
        uvec2 tie = ties_here[end];
        if (tie.y > 0u && (end == 0u || tie.x != ties_here[0].x)) {
            send(tie, bounds);
        }
    }
}
