#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the blocks whose Gaussians differ, in order, and writes the indirect command over them.
struct Params {
    uint stage; // which stage they are for: 0 clip, 1 classify
};
#define PARAMS Params
#include "block_runs.glsl"
#include "region/sides.glsl"
#include "groups.glsl"

BUFFER(readonly, 1, uint, sides)
BUFFER(writeonly, 2, uint, block_list)
BUFFER(writeonly, 3, FrameCounts, counts)

bool differs(uint block) {
    return (sides.at[block] & SIDE_BITS) == SIDE_CUTOFF;
}

uvec4 totals_of(uint block) {
    return uvec4(differs(block) ? 1u : 0u, 0u, 0u, 0u);
}

void main() {
    BlockRun run = block_run();
    uint place = run.before.x;
    for (uint block = run.bounds.x; block < run.bounds.y; block++) {
        if (differs(block)) {
            block_list.at[place++] = block | (sides.at[block] & WHOLLY_IN_VIEW);
        }
    }
    if (run.is_last) {
        if (push.params.stage == 0u) {
            counts.at[0].clip_groups = groups(place, 1u);
        } else {
            counts.at[0].classify_groups = groups(place, 1u);
        }
    }
}
