// The greatest value of the invocations of a workgroup of RADIX_GROUP_SIZE, without subgroup operations.
#ifndef RARA_WORKGROUP_MAX
#define RARA_WORKGROUP_MAX
#include "limits.glsl"

shared uint maxima[RADIX_GROUP_SIZE];

// The greatest value of all invocations before this one, 0 for the first.
uint exclusive_max(uint value) {
    uint local = gl_LocalInvocationIndex;
    maxima[local] = value;
    barrier();
    for (uint distance = 1u; distance < RADIX_GROUP_SIZE; distance *= 2u) {
        uint before = local >= distance ? maxima[local - distance] : 0u;
        barrier();
        maxima[local] = max(maxima[local], before);
        barrier();
    }
    return local > 0u ? maxima[local - 1u] : 0u;
}

#endif
