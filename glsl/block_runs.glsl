// Runs of consecutive blocks, one for each invocation of the workgroups that a list of blocks is made by: a single one of one
// row on CPU drivers, and one of BLOCK_SIZE invocations for as many blocks on GPUs. Each workgroup adds up the blocks before
// its own by itself, so that none waits for another.
#ifndef RARA_BLOCK_RUNS
#define RARA_BLOCK_RUNS
#include "frame.glsl"
#include "runs.glsl"

layout(local_size_x_id = 14) in;
const uint RUNS = gl_WorkGroupSize.x; // of a workgroup

// The counts of a block that are added up. Whoever includes this defines it.
uvec4 totals_of(uint block);

struct BlockRun {
    uvec2 bounds; // first and last block (exclusive)
    uvec4 before; // the counts of all blocks before it
    bool is_last;
};

// Blocks that an invocation looks at before it waits for their counts.
const uint BLOCKS_AT_ONCE = 8u;

// The invocations stand in rows, as in workgroup_sum.glsl.
const uint RUN_ROWS = (RUNS + RUN_ROW - 1u) / RUN_ROW;

shared uvec4 run_totals[RUNS];
shared uvec4 earlier_totals[RUNS];
// The totals of each row: of its runs, and of everything earlier that its invocations have found.
shared uvec4 runs_of_rows[RUN_ROWS];
shared uvec4 earlier_of_rows[RUN_ROWS];

BlockRun block_run() {
    uint local = gl_LocalInvocationIndex;
    uint runs = gl_NumWorkGroups.x * RUNS;
    uint blocks = CUT.scene.block_count;
    uvec2 bounds = run_bounds(gl_GlobalInvocationID.x, runs, blocks);
    uvec4 total = uvec4(0u);
    for (uint block = bounds.x; block < bounds.y; block++) {
        total += totals_of(block);
    }
    uint workgroup_begin = run_bounds(gl_WorkGroupID.x * RUNS, runs, blocks).x;
    uvec4 earlier = uvec4(0u);
    for (uint first = 0u; first < workgroup_begin; first += BLOCKS_AT_ONCE * RUNS) {
        for (uint k = 0u; k < BLOCKS_AT_ONCE; k++) {
            uint block = first + k * RUNS + local;
            uvec4 totals = totals_of(min(block, workgroup_begin - 1u));
            earlier += block < workgroup_begin ? totals : uvec4(0u);
        }
    }
    run_totals[local] = total;
    earlier_totals[local] = earlier;
    barrier();
    uint row = local / RUN_ROW;
    uint place = local % RUN_ROW;
    uvec4 before = uvec4(0u);
    uvec4 others = uvec4(0u);
    for (uint i = row * RUN_ROW; i < local; i++) {
        before += run_totals[i];
        others += earlier_totals[i];
    }
    if (place == RUN_ROW - 1u) {
        runs_of_rows[row] = before + total;
        earlier_of_rows[row] = others + earlier;
    }
    barrier();
    for (uint i = 0u; i < row; i++) {
        before += runs_of_rows[i];
    }
    for (uint i = 0u; i < RUN_ROWS; i++) {
        before += earlier_of_rows[i];
    }
    return BlockRun(bounds, before, gl_GlobalInvocationID.x == runs - 1u);
}

#endif
