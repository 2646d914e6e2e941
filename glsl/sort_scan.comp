#version 460
#extension GL_GOOGLE_include_directive : require
// Second step of a pass, one workgroup, a digit an invocation: the runs' counts become the places where each run's keys
// of each digit begin.
#include "sort.glsl"

layout(local_size_x = DIGITS) in;

BUFFER(, 1, uint, histogram)

shared uint totals[DIGITS];

void main() {
    uint d = gl_LocalInvocationIndex;
    uint total = 0u;
    for (uint run = 0u; run < FRAME.sort_runs; run++) {
        total += histogram.at[run * DIGITS + d];
    }
    totals[d] = total;
    barrier();
    uint place = 0u;
    for (uint before = 0u; before < d; before++) {
        place += totals[before];
    }
    for (uint run = 0u; run < FRAME.sort_runs; run++) {
        uint count = histogram.at[run * DIGITS + d];
        histogram.at[run * DIGITS + d] = place;
        place += count;
    }
}
