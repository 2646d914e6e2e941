// A radix sort for GPUs: reduce, then scan. A workgroup owns a partition of consecutive keys. The histogram holds, digit by
// digit, how many keys of the digit each partition has; behind that how many there are of each digit in all, and behind
// that the least and the greatest key of each partition.
#ifndef RARA_RADIX
#define RARA_RADIX
#include "sort.glsl"

// Keys of an invocation.
const uint RADIX_KEYS = RADIX_PARTITION / RADIX_GROUP_SIZE;
// It waits for so many of them together, where it needs more than the keys.
const uint KEYS_AT_ONCE = 4u;

// p is the number of a partition.
#define PARTITIONS ((KEY_COUNT + RADIX_PARTITION - 1u) / RADIX_PARTITION)
#define COUNT_PLACE(digit, p) ((digit) * PARTITIONS + (p))
#define TOTAL_PLACE(digit) (DIGITS * PARTITIONS + (digit))
#define RANGES PARTITIONS
#define RANGE_PLACE(p) (DIGITS * PARTITIONS + DIGITS + 2u * (p))

// First and last key (exclusive) of a partition.
uvec2 partition_bounds(uint p, uint count) {
    uint begin = min(p * RADIX_PARTITION, count);
    return uvec2(begin, min(begin + RADIX_PARTITION, count));
}

#endif
