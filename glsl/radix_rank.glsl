// Sorts the positions of a partition by a digit, in shared memory. Included by workgroups of RADIX_GROUP_SIZE.
//
// With RARA_SUBGROUP, of 8 invocations or more, invocations of one digit find each other by ballots; each subgroup counts its
// own consecutive keys. Otherwise each invocation counts its own consecutive keys, in two rounds of half a digit, since
// counts of all digits for each invocation have no room.
#ifndef RARA_RADIX_RANK
#define RARA_RADIX_RANK
#include "radix.glsl"
#include "workgroup_sum.glsl"

// The result: the positions by ascending digit, those of one digit in order. An item is its digit times RADIX_PARTITION and
// its position.
shared uint items[RADIX_PARTITION];
// The place of the first item of each digit that occurs.
shared uint digit_begins[DIGITS];

uint item_digit(uint item) {
    return item / RADIX_PARTITION;
}

uint item_position(uint item) {
    return item % RADIX_PARTITION;
}

#ifdef RARA_SUBGROUP

// The position of an invocation's key number k.
uint position_of(uint k) {
    return (gl_SubgroupID * RADIX_KEYS + k) * gl_SubgroupSize + gl_SubgroupInvocationID;
}

// Sorts by the digits of this invocation's keys. Two digits share a word of counts: no count exceeds 16 bits.
void sort_positions(uint digits[RADIX_KEYS]) {
    const uint HALF = DIGITS / 2u;
    uint local = gl_LocalInvocationIndex;
    // Until the items are there, their place holds the counts of each subgroup.
    for (uint i = local; i < gl_NumSubgroups * HALF; i += RADIX_GROUP_SIZE) {
        items[i] = 0u;
    }
    barrier();
    uvec4 every = subgroupBallot(true);
    uint ranks[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint d = digits[k];
        uvec4 same = every;
        for (uint bit = 0u; bit < SORT_BITS; bit++) {
            bool is_set = (d >> bit & 1u) != 0u;
            uvec4 set = subgroupBallot(is_set);
            same &= is_set ? set : ~set;
        }
        uint first = subgroupBallotFindLSB(same);
        uint shift = d / HALF * 16u;
        // The first of a digit counts for all of them. The others add nothing, rather than leave it out: invocations that
        // take different ways need not come together again before the next ballot.
        uint added = gl_SubgroupInvocationID == first ? subgroupBallotBitCount(same) << shift : 0u;
        uint before = atomicAdd(items[gl_SubgroupID * HALF + d % HALF], added);
        before = subgroupShuffle(before, first);
        ranks[k] = bitfieldExtract(before, int(shift), 16) + subgroupBallotBitCount(same & gl_SubgroupLtMask);
        subgroupMemoryBarrierShared();
        subgroupBarrier();
    }
    barrier();
    if (local < HALF) {
        uint both = 0u;
        for (uint slot = local; slot < gl_NumSubgroups * HALF; slot += HALF) {
            uint here = items[slot];
            items[slot] = both;
            both += here;
        }
        digit_begins[local] = both & 0xffffu;
        digit_begins[local + HALF] = both >> 16;
    }
    barrier();
    uint total;
    uint begin = exclusive_sum(digit_begins[local], total);
    digit_begins[local] = begin;
    barrier();
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint d = digits[k];
        uint before = items[gl_SubgroupID * HALF + d % HALF];
        ranks[k] += digit_begins[d] + bitfieldExtract(before, int(d / HALF * 16u), 16);
    }
    barrier();
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        items[ranks[k]] = digits[k] * RADIX_PARTITION + position_of(k);
    }
    barrier();
}

#else

const uint HALF_BITS = SORT_BITS / 2u;
// Words of an invocation's counts: two digits share one, no count exceeds 16 bits.
const uint COUNT_WORDS = (1u << HALF_BITS) / 2u;

shared uint half_counts[COUNT_WORDS * RADIX_GROUP_SIZE];

// The position of an invocation's key number k.
uint position_of(uint k) {
    return gl_LocalInvocationIndex * RADIX_KEYS + k;
}

// Moves each invocation's items to their places by half a digit.
void split(uint mine[RADIX_KEYS], int bit) {
    uint local = gl_LocalInvocationIndex;
    for (uint word = 0u; word < COUNT_WORDS; word++) {
        half_counts[word * RADIX_GROUP_SIZE + local] = 0u;
    }
    uint places[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint d = bitfieldExtract(item_digit(mine[k]), bit, int(HALF_BITS));
        uint slot = d % COUNT_WORDS * RADIX_GROUP_SIZE + local;
        uint shift = d / COUNT_WORDS * 16u;
        places[k] = bitfieldExtract(half_counts[slot], int(shift), 16);
        half_counts[slot] += 1u << shift;
    }
    barrier();
    // The counts of a digit lie together, so what stands before a count in memory belongs before it.
    uint sum = 0u;
    for (uint word = 0u; word < COUNT_WORDS; word++) {
        uint here = half_counts[local * COUNT_WORDS + word];
        half_counts[local * COUNT_WORDS + word] = sum;
        sum += here;
    }
    uint total;
    uint before = exclusive_sum(sum, total);
    before += total << 16; // the digits of the upper halves come after all of the lower ones
    for (uint word = 0u; word < COUNT_WORDS; word++) {
        half_counts[local * COUNT_WORDS + word] += before;
    }
    barrier();
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        uint d = bitfieldExtract(item_digit(mine[k]), bit, int(HALF_BITS));
        uint slot = d % COUNT_WORDS * RADIX_GROUP_SIZE + local;
        places[k] += bitfieldExtract(half_counts[slot], int(d / COUNT_WORDS * 16u), 16);
    }
    barrier();
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        items[places[k]] = mine[k];
    }
    barrier();
}

// Sorts by the digits of this invocation's keys. Both rounds share their code: CPU drivers take a time to compile it that grows
// faster than the number of its barriers.
void sort_positions(uint digits[RADIX_KEYS]) {
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        items[position_of(k)] = digits[k] * RADIX_PARTITION + position_of(k);
    }
    for (int bit = 0; bit < int(SORT_BITS); bit += int(HALF_BITS)) {
        // Each round ends with a barrier, and has others before it changes an item.
        uint mine[RADIX_KEYS];
        for (uint k = 0u; k < RADIX_KEYS; k++) {
            mine[k] = items[position_of(k)];
        }
        split(mine, bit);
    }
    for (uint i = gl_LocalInvocationIndex; i < RADIX_PARTITION; i += RADIX_GROUP_SIZE) {
        uint d = item_digit(items[i]);
        if (i == 0u || item_digit(items[i - 1u]) != d) {
            digit_begins[d] = i;
        }
    }
    barrier();
}

#endif
#endif
