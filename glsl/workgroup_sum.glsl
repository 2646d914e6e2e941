// Sums over the invocations of a workgroup of RADIX_GROUP_SIZE, without subgroup operations.
#ifndef RARA_WORKGROUP_SUM
#define RARA_WORKGROUP_SUM
#include "limits.glsl"
#include "capped_sum.glsl"

shared uint sums[RADIX_GROUP_SIZE];

// The sum of the values of all invocations before this one, and of all of them.
uint exclusive_sum(uint value, out uint total) {
    uint local = gl_LocalInvocationIndex;
    sums[local] = value;
    barrier();
    for (uint distance = 1u; distance < RADIX_GROUP_SIZE; distance *= 2u) {
        uint before = local >= distance ? sums[local - distance] : 0u;
        barrier();
        sums[local] += before;
        barrier();
    }
    total = sums[RADIX_GROUP_SIZE - 1u];
    uint sum = sums[local] - value;
    barrier();
    return sum;
}

// The capped sum of the values of all invocations.
uint capped_total(uint value) {
    uint local = gl_LocalInvocationIndex;
    sums[local] = value;
    barrier();
    for (uint rest = RADIX_GROUP_SIZE / 2u; rest > 0u; rest /= 2u) {
        if (local < rest) {
            sums[local] = capped_sum(sums[local], sums[local + rest]);
        }
        barrier();
    }
    uint total = sums[0];
    barrier();
    return total;
}

#endif
