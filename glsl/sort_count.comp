#version 460
#extension GL_GOOGLE_include_directive : require
// First step of a pass: how often each run holds each digit. A run's counts lie together, one run after the other.
#include "sort.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, keys)
BUFFER(, 3, uint, histogram)

void main() {
    uint run = gl_GlobalInvocationID.x;
    for (uint d = 0u; d < DIGITS; d++) {
        histogram.at[run * DIGITS + d] = 0u;
    }
    uvec2 bounds = run_bounds(run, KEY_COUNT);
    for (uint i = bounds.x; i < bounds.y; i++) {
        histogram.at[run * DIGITS + digit(keys.at[i])]++;
    }
}
