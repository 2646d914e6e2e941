#version 460
#extension GL_GOOGLE_include_directive : require
// After the sort for GPUs, splats of one depth are in the order of the blocks; this puts them into that of their numbers. An
// invocation orders a few alone. Where more have one depth, the workgroup of the first ranks them, or sorts them by the digits
// in which their numbers differ, partition by partition: a layer of one depth keeps one workgroup busy for a while.
#include "radix_rank.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(coherent, 3, uint, order)
BUFFER(coherent, 4, uint, scratch)
BUFFER(readonly, 5, uint, depth_keys)
// The numbers of those that are sorted by digits, by survivor.
BUFFER(coherent, 6, uint, numbers)
#include "ties.glsl"

// The first of each many that begin in this partition.
shared uint begins[RADIX_PARTITION / TIES_ALONE];
shared uint begin_count;
shared uint last; // of those that are sorted together, exclusive
shared uint offsets[DIGITS]; // where their next of each digit goes

// One past the last key that equals the one at `begin`.
uint end_of(uint begin) {
    uint count = KEY_COUNT;
    uint key = keys.at[begin];
    if (gl_LocalInvocationIndex == 0u) {
        last = count;
    }
    for (uint first = begin; ; first += RADIX_GROUP_SIZE) {
        barrier();
        uint i = first + gl_LocalInvocationIndex;
        if (i < count && keys.at[i] != key) {
            atomicMin(last, i);
        }
        barrier();
        if (last <= first + RADIX_GROUP_SIZE) {
            return last;
        }
    }
}

// Does so partition by partition, each as in a pass of the sort.
void sort_by_digit(bool second, uint begin, uint end, uint digit_number) {
    uint local = gl_LocalInvocationIndex;
    offsets[local] = 0u;
    barrier();
    for (uint i = begin + local; i < end; i += RADIX_GROUP_SIZE) {
        atomicAdd(offsets[digit(numbers.at[at(second, i)], digit_number)], 1u);
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
            digits[k] = position < count ? digit(numbers.at[at(second, first + position)], digit_number) : DIGITS - 1u;
        }
        sort_positions(digits);
        for (uint i = local; i < count; i += RADIX_GROUP_SIZE) {
            uint item = items[i];
            uint d = item_digit(item);
            put(!second, offsets[d] + i - digit_begins[d], at(second, first + item_position(item)));
        }
        barrier();
        for (uint i = local; i < count; i += RADIX_GROUP_SIZE) {
            uint d = item_digit(items[i]);
            if (i + 1u == count || item_digit(items[i + 1u]) != d) {
                offsets[d] += i + 1u - digit_begins[d];
            }
        }
        barrier();
    }
    publish();
}

// Orders as many as there are invocations: each counts those that belong before its own.
void rank_together(uint begin, uint end) {
    uint local = gl_LocalInvocationIndex;
    uint count = end - begin;
    uint survivor = local < count ? order.at[begin + local] : 0u;
    uint its_number = local < count ? number(survivor) : 0u;
    items[local] = its_number;
    barrier();
    uint rank = 0u;
    for (uint other = 0u; other < count; other++) {
        rank += items[other] < its_number ? 1u : 0u;
    }
    if (local < count) {
        order.at[begin + rank] = survivor;
    }
    publish();
}

void main() {
    uint count = KEY_COUNT;
    uvec2 bounds = partition_bounds(gl_WorkGroupID.x, count);
    if (gl_LocalInvocationIndex == 0u) {
        begin_count = 0u;
    }
    barrier();
    for (uint i = bounds.x + gl_LocalInvocationIndex; i < bounds.y; i += RADIX_GROUP_SIZE) {
        uint key = keys.at[i];
        if (i + 1u >= count || keys.at[i + 1u] != key || (i > 0u && keys.at[i - 1u] == key)) {
            continue; // no others have its depth, or they begin before it
        }
        uint end = i + 2u;
        while (end < count && end - i <= TIES_ALONE && keys.at[end] == key) {
            end++;
        }
        if (end - i <= TIES_ALONE) {
            order_alone(i, end);
        } else {
            begins[atomicAdd(begin_count, 1u)] = i; // in any order: they are sorted each by itself
        }
    }
    barrier();
    for (uint tie = 0u; tie < begin_count; tie++) {
        uint begin = begins[tie];
        uint end = end_of(begin);
        if (end - begin <= RADIX_GROUP_SIZE) {
            rank_together(begin, end);
        } else {
            sort_together(begin, end);
        }
    }
}
