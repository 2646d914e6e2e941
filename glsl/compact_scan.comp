#version 460
#extension GL_GOOGLE_include_directive : require
// Turns the blocks' totals into each block's place in the lists, the frame's counts and the indirect commands of all later
// stages. Each invocation owns a run of blocks, so the order is that of the scene.
#include "block_runs.glsl"
#include "layer.glsl"
#include "region/sides.glsl"
#include "groups.glsl"

BUFFER(readonly, 1, uint, block_sides)
BUFFER(readonly, 2, uvec4, block_counts)
BUFFER(writeonly, 3, uvec2, block_offsets)
BUFFER_OF(writeonly, 4, block_list, uvec4 groups; uint at[])
BUFFER(writeonly, 5, FrameCounts, counts)

// Visible, cut and invisible Gaussians of a block, and 1 where some survive.
uvec4 totals_of(uint block) {
    enter_layer_of_block(block);
    uint side = block_sides.at[block] & SIDE_BITS;
    // Those of a block that is settled mean nothing, but are there without another wait.
    uvec3 counted = block_counts.at[block].xyz;
    uvec3 totals = side == SIDE_CUTOFF ? counted
        : uvec3(side == SIDE_VISIBLE ? 1u : 0u, 0u, side == SIDE_INVISIBLE ? 1u : 0u) * block_length(block);
    return uvec4(totals, totals.x + totals.y > 0u ? 1u : 0u);
}

void main() {
    BlockRun run = block_run();
    uvec4 place = run.before;
    for (uint block = run.bounds.x; block < run.bounds.y; block++) {
        uvec4 here = totals_of(block);
        if (here.w != 0u) {
            block_offsets.at[block] = uvec2(place.x + place.y, place.y);
            block_list.at[place.w] = block;
        }
        place += here;
    }
    if (run.is_last) {
        uint splats = place.x + place.y;
        counts.at[0].visible = place.x;
        counts.at[0].cutoff = place.y;
        counts.at[0].long_records = 0u;
        counts.at[0].long_strides = 0u;
        counts.at[0].invisible = place.z;
        counts.at[0].culled = CUT.scene.gaussian_count - splats - place.z;
        block_list.groups = groups(place.w, 1u);
        counts.at[0].project_groups = groups(splats, SPLAT_GROUP_SIZE);
        counts.at[0].cutoff_groups = groups(place.y, SPLAT_GROUP_SIZE);
        // Even a single splat is sorted: the passes carry it to the buffer that the draw reads.
        uint sort_groups = EYE.order.sort_runs > 0u ? EYE.order.sort_runs / SORT_GROUP_SIZE
            : (splats + RADIX_PARTITION - 1u) / RADIX_PARTITION;
        counts.at[0].sort_groups = uvec4(splats == 0u ? 0u : sort_groups, 1u, 1u, 0u);
        counts.at[0].draw = uvec4(4u, splats, 0u, 0u);
        counts.at[0].mesh_groups = groups(splats, MESH_GROUP_SIZE);
        // Where tiles are wanted, binning counts them.
        counts.at[0].pairs = 0u;
        counts.at[0].has_room = 0u;
        counts.at[0].span_count_groups = uvec4(splats == 0u ? 0u : EYE.tiles.span_runs / SPAN_GROUP_SIZE, 1u, 1u, 0u);
        counts.at[0].span_groups = uvec4(0u);
        counts.at[0].part_groups = uvec4(0u);
        counts.at[0].row_groups = uvec4(0u);
        counts.at[0].macro_pairs = 0u;
        counts.at[0].excess_pairs = 0u;
        counts.at[0].pair_groups = uvec4(0u);
        counts.at[0].batch_groups = uvec4(0u);
        counts.at[0].tile_groups = uvec4(0u);
        counts.at[0].several_tile_groups = uvec4(0u);
        counts.at[0].composite = uvec4(0u);
    }
}
