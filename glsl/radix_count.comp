#version 460
#extension GL_GOOGLE_include_directive : require
// The first step of a pass of the sort for GPUs counts how often each partition holds each digit. That of the first pass also
// finds the least and the greatest key of each.
struct Params {
    uint pass; // of the sort, from 0
};
#define PARAMS Params
#include "radix_keys.glsl"
#include "radix.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(writeonly, 3, uint, histogram)

// The results do not depend on the order in which invocations add to these.
shared uint totals[DIGITS];
shared uint least;
shared uint greatest;

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    totals[local] = 0u;
    if (local == 0u) {
        least = ~0u;
        greatest = 0u;
    }
    barrier();
    bool is_first = !PAIRS && push.params.pass == 0u;
    uint number = is_first ? 0u : KEY_DIGIT;
    uint base = number == 0u ? 0u : KEY_BASE;
    uvec2 bounds = partition_bounds(p, KEY_COUNT);
    uint my_least = ~0u;
    uint my_greatest = 0u;
    uint own[RADIX_KEYS];
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        own[k] = keys.at[min(bounds.x + k * RADIX_GROUP_SIZE + local, bounds.y - 1u)];
    }
    for (uint k = 0u; k < RADIX_KEYS; k++) {
        // Those beyond the end are the last key once more.
        my_least = min(my_least, own[k]);
        my_greatest = max(my_greatest, own[k]);
        if (bounds.x + k * RADIX_GROUP_SIZE + local < bounds.y) {
            atomicAdd(totals[digit(SORTED_BITS(own[k]) - base, number)], 1u);
        }
    }
    if (is_first) {
        atomicMin(least, my_least);
        atomicMax(greatest, my_greatest);
    }
    barrier();
    histogram.at[COUNT_PLACE(local, p)] = totals[local];
    if (is_first && local == 0u) {
        histogram.at[RANGE_PLACE(p)] = least;
        histogram.at[RANGE_PLACE(p) + 1u] = greatest;
    }
}
