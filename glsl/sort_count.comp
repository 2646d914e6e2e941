#version 460
#extension GL_GOOGLE_include_directive : require
// The first step of a pass counts how often each run holds each digit. A run's counts lie together, one run after the
// other; behind them all are the least and the greatest key of each.
struct Params {
    uint pass; // of the sort, from 0
};
#define PARAMS Params
#include "sort_runs.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(, 3, uint, histogram)

void main() {
    uint run = gl_GlobalInvocationID.x;
    for (uint d = 0u; d < DIGITS; d++) {
        histogram.at[run * DIGITS + d] = 0u;
    }
    uint number = push.params.pass == 0u ? 0u : KEY_DIGIT;
    uint base = number == 0u ? 0u : KEY_BASE;
    uvec2 bounds = run_bounds(run, EYE.order.sort_runs, KEY_COUNT);
    uint least = ~0u;
    uint greatest = 0u;
    for (uint i = bounds.x; i < bounds.y; i++) {
        uint key = keys.at[i];
        histogram.at[run * DIGITS + digit(key - base, number)]++;
        least = min(least, key);
        greatest = max(greatest, key);
    }
    histogram.at[RANGE_PLACE(run)] = least;
    histogram.at[RANGE_PLACE(run) + 1u] = greatest;
}
