#version 460
#extension GL_GOOGLE_include_directive : require
// The second step of a pass of the sort for GPUs: a workgroup a digit turns the partitions' counts of it into how many keys of
// the digit stand in the partitions before. In the first pass the first workgroup decides which passes are skipped.
struct Params {
    uint pass; // of the sort, from 0
    uint passes; // of the sort, if none is skipped
};
#define PARAMS Params
#include "radix_keys.glsl"
#include "radix.glsl"
#include "workgroup_sum.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(, 1, FrameCounts, counts)
BUFFER(, 2, uint, histogram)
#include "sort_passes.glsl"

void main() {
    uint d = gl_WorkGroupID.x;
    uint partitions = PARTITIONS;
    if (PAIRS) {
        // Every pass counts.
    } else if (push.params.pass == 0u) {
        if (d == 0u) {
            decide_passes(push.params.passes);
        }
    } else if (push.params.pass <= counts.at[0].sort_skipped) {
        return; // this pass is skipped
    }
    uint counts_begin = COUNT_PLACE(d, 0u);
    uint before = 0u;
    // An invocation has consecutive partitions, whose counts it waits for together.
    for (uint first = 0u; first < partitions; first += RADIX_GROUP_SIZE * RADIX_SCAN_COUNTS) {
        uint p = first + gl_LocalInvocationIndex * RADIX_SCAN_COUNTS;
        uint own[RADIX_SCAN_COUNTS];
        uint sum = 0u;
        for (uint k = 0u; k < RADIX_SCAN_COUNTS; k++) {
            uint count = histogram.at[counts_begin + min(p + k, partitions - 1u)];
            own[k] = p + k < partitions ? count : 0u;
            sum += own[k];
        }
        uint total;
        uint place = before + exclusive_sum(sum, total);
        for (uint k = 0u; k < RADIX_SCAN_COUNTS; k++) {
            if (p + k < partitions) {
                histogram.at[counts_begin + p + k] = place;
            }
            place += own[k];
        }
        before += total;
    }
    if (gl_LocalInvocationIndex == 0u) {
        histogram.at[DIGITS * partitions + d] = before;
    }
}
