// Where a workgroup's next keys of each digit go, which carries several partitions one after the other.
#ifndef RARA_RADIX_CARRY
#define RARA_RADIX_CARRY
#include "radix_rank.glsl"

shared uint offsets[DIGITS];

// Moves on by the sorted items of a partition, of which so many count.
void advance(uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += RADIX_GROUP_SIZE) {
        uint d = item_digit(items[i]);
        if (i + 1u == count || item_digit(items[i + 1u]) != d) {
            offsets[d] += i + 1u - digit_begins[d];
        }
    }
    barrier();
}

#endif
