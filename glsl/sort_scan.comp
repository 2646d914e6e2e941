#version 460
#extension GL_GOOGLE_include_directive : require
// The second step of a pass, one workgroup with an invocation for each digit, turns the runs' counts into the places where
// each run's keys of each digit begin. That of the first pass decides which passes are skipped.
struct Params {
    uint pass; // of the sort, from 0
    uint passes; // of the sort, if none is skipped
};
#define PARAMS Params
#include "sort_runs.glsl"

layout(local_size_x = DIGITS) in;

BUFFER(, 1, FrameCounts, counts)
BUFFER(, 2, uint, histogram)
#include "sort_passes.glsl"

shared uint totals[DIGITS];

void main() {
    uint pass = push.params.pass;
    uint d = gl_LocalInvocationIndex;
    if (pass == 0u) {
        decide_passes(push.params.passes);
    } else if (pass <= counts.at[0].sort_skipped) {
        return; // this pass is skipped
    }
    uint total = 0u;
    for (uint run = 0u; run < EYE.order.sort_runs; run++) {
        total += histogram.at[run * DIGITS + d];
    }
    totals[d] = total;
    barrier();
    uint place = 0u;
    for (uint before = 0u; before < d; before++) {
        place += totals[before];
    }
    for (uint run = 0u; run < EYE.order.sort_runs; run++) {
        uint count = histogram.at[run * DIGITS + d];
        histogram.at[run * DIGITS + d] = place;
        place += count;
    }
}
