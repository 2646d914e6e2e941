// Sums over the invocations of a workgroup of RADIX_GROUP_SIZE, without subgroup operations.
#ifndef RARA_WORKGROUP_SUM
#define RARA_WORKGROUP_SUM
#include "limits.glsl"
#include "capped_sum.glsl"

// The invocations stand in rows. Each adds up its own row as far as itself, and then the rows before, between two barriers, where
// doubling distances would need twice as many barriers as the workgroup's size has bits. Loops that end at the invocation's
// place need no mask of their own for each step, which on GPUs would take registers from all that follows.
const uint SUM_ROW = 16u;
const uint SUM_ROWS = RADIX_GROUP_SIZE / SUM_ROW;

shared uint sums[RADIX_GROUP_SIZE];
shared uint sums_of_rows[SUM_ROWS];

// The sum of the values of all invocations before this one, and of all of them.
uint exclusive_sum(uint value, out uint total) {
    uint local = gl_LocalInvocationIndex;
    uint place = local % SUM_ROW;
    uint row = local / SUM_ROW;
    sums[local] = value;
    barrier();
    uint sum = 0u;
    for (uint i = row * SUM_ROW; i < local; i++) {
        sum += sums[i];
    }
    if (place == SUM_ROW - 1u) {
        sums_of_rows[row] = sum + value;
    }
    barrier();
    for (uint i = 0u; i < row; i++) {
        sum += sums_of_rows[i];
    }
    total = 0u;
    for (uint i = 0u; i < SUM_ROWS; i++) {
        total += sums_of_rows[i];
    }
    // No barrier follows: the next sum writes to sums_of_rows only after a barrier of its own.
    return sum;
}

// The capped sum of the values of all invocations.
uint capped_total(uint value) {
    uint local = gl_LocalInvocationIndex;
    sums[local] = value;
    barrier();
    if (local < SUM_ROWS) {
        uint sum = 0u;
        for (uint i = 0u; i < SUM_ROW; i++) {
            sum = capped_sum(sum, sums[i * SUM_ROWS + local]);
        }
        sums_of_rows[local] = sum;
    }
    barrier();
    uint total = 0u;
    for (uint i = 0u; i < SUM_ROWS; i++) {
        total = capped_sum(total, sums_of_rows[i]);
    }
    return total;
}

#endif
