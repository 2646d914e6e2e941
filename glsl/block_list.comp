#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the blocks whose Gaussians differ, in order, behind the indirect command over them. It serves cuts, and frames, whose
// constants begin with those of their cut.
#define OF_CUT
#include "block_runs.glsl"
#include "region/sides.glsl"
#include "groups.glsl"

BUFFER(readonly, 1, uint, sides)
BUFFER_OF(writeonly, 2, block_list, uvec4 groups; uint at[])

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
        block_list.groups = groups(place, 1u);
    }
}
