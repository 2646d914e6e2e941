#version 460
#extension GL_GOOGLE_include_directive : require
// Third step of a pass: each run carries its keys, in order, to their places.
#include "sort.glsl"

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(readonly, 3, uint, order)
BUFFER(, 4, uint, histogram)
BUFFER(readonly, 5, uint, digit_totals)
BUFFER(writeonly, 6, uint, sorted_keys)
BUFFER(writeonly, 7, uint, sorted_order)

shared uint digit_starts[DIGITS];

void main() {
    const uint part = DIGITS / SORT_GROUP_SIZE;
    uint first = gl_LocalInvocationIndex * part;
    uint start = 0u;
    for (uint d = 0u; d < first; d++) {
        start += digit_totals.at[d];
    }
    for (uint d = first; d < first + part; d++) {
        digit_starts[d] = start;
        start += digit_totals.at[d];
    }
    barrier();
    uint run = gl_GlobalInvocationID.x;
    uvec2 bounds = run_bounds(run, counts.at[0].visible + counts.at[0].cutoff);
    for (uint i = bounds.x; i < bounds.y; i++) {
        uint key = keys.at[i];
        uint d = digit(key);
        uint slot = d * FRAME.sort_runs + run;
        uint place = histogram.at[slot];
        histogram.at[slot] = place + 1u;
        sorted_keys.at[digit_starts[d] + place] = key;
        sorted_order.at[digit_starts[d] + place] = order.at[i];
    }
}
