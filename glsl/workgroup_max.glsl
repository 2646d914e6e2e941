// The greatest value of the invocations of a workgroup of RADIX_GROUP_SIZE, without subgroup operations.
#ifndef RARA_WORKGROUP_MAX
#define RARA_WORKGROUP_MAX
#include "limits.glsl"

// The invocations stand in rows, as in workgroup_sum.glsl.
const uint MAX_ROW = 16u;
const uint MAX_ROWS = RADIX_GROUP_SIZE / MAX_ROW;

shared uint maxima[RADIX_GROUP_SIZE];
shared uint maxima_of_rows[MAX_ROWS];

// The greatest value of all invocations before this one, 0 for the first.
uint exclusive_max(uint value) {
    uint local = gl_LocalInvocationIndex;
    uint place = local % MAX_ROW;
    uint row = local / MAX_ROW;
    maxima[local] = value;
    barrier();
    uint most = 0u;
    for (uint i = row * MAX_ROW; i < local; i++) {
        most = max(most, maxima[i]);
    }
    if (place == MAX_ROW - 1u) {
        maxima_of_rows[row] = max(most, value);
    }
    barrier();
    for (uint i = 0u; i < row; i++) {
        most = max(most, maxima_of_rows[i]);
    }
    // No barrier follows: the next call writes to maxima_of_rows only after a barrier of its own.
    return most;
}

#endif
