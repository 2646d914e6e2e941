#version 460
#extension GL_GOOGLE_include_directive : require
// Second step of a pass: one workgroup a digit turns the runs' counts into places among the keys of that digit.
#include "sort.glsl"

BUFFER(, 1, uint, histogram)
BUFFER(writeonly, 2, uint, digit_totals)

shared uint part_totals[SORT_GROUP_SIZE];

void main() {
    uint base = gl_WorkGroupID.x * FRAME.sort_runs;
    uint part = FRAME.sort_runs / SORT_GROUP_SIZE;
    uint begin = base + gl_LocalInvocationIndex * part;
    uint total = 0u;
    for (uint i = begin; i < begin + part; i++) {
        total += histogram.at[i];
    }
    part_totals[gl_LocalInvocationIndex] = total;
    barrier();
    uint before = 0u;
    for (uint other = 0u; other < gl_LocalInvocationIndex; other++) {
        before += part_totals[other];
    }
    for (uint i = begin; i < begin + part; i++) {
        uint count = histogram.at[i];
        histogram.at[i] = before;
        before += count;
    }
    if (gl_LocalInvocationIndex == SORT_GROUP_SIZE - 1u) {
        digit_totals.at[gl_WorkGroupID.x] = before;
    }
}
