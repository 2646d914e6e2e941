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
    uint before = 0u;
    for (uint first = 0u; first < partitions; first += RADIX_GROUP_SIZE) {
        uint p = first + gl_LocalInvocationIndex;
        uint place = COUNT_PLACE(d, p);
        uint count = p < partitions ? histogram.at[place] : 0u;
        uint total;
        uint sum = exclusive_sum(count, total);
        if (p < partitions) {
            histogram.at[place] = before + sum;
        }
        before += total;
    }
    if (gl_LocalInvocationIndex == 0u) {
        histogram.at[TOTAL_PLACE(d)] = before;
    }
}
