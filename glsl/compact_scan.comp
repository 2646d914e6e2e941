#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup: turns the workgroups' totals into each one's place in the lists, the frame's counts and the indirect
// commands of everything after. Each invocation owns a run of workgroups, so the order is that of the file.
#include "frame.glsl"

layout(local_size_x = GROUP_SIZE) in;

BUFFER(readonly, 1, uvec4, group_counts)
BUFFER(writeonly, 2, uvec2, group_offsets)
BUFFER(writeonly, 3, FrameCounts, counts)

shared uvec3 run_totals[GROUP_SIZE];

// Workgroups for `count` items, folded into rows when there are more than a row holds.
uvec4 groups(uint count, uint size) {
    uint needed = (count + size - 1u) / size;
    return uvec4(min(needed, GROUP_COLUMNS), (needed + GROUP_COLUMNS - 1u) / GROUP_COLUMNS, 1u, 0u);
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint run = (FRAME.group_count + GROUP_SIZE - 1u) / GROUP_SIZE;
    uint begin = min(local * run, FRAME.group_count);
    uint end = min(begin + run, FRAME.group_count);
    uvec3 total = uvec3(0u);
    for (uint group = begin; group < end; group++) {
        total += group_counts.at[group].xyz;
    }
    run_totals[local] = total;
    barrier();
    uvec3 before = uvec3(0u);
    for (uint other = 0u; other < local; other++) {
        before += run_totals[other];
    }
    uvec2 offset = uvec2(before.x + before.y, before.y);
    for (uint group = begin; group < end; group++) {
        group_offsets.at[group] = offset;
        uvec3 here = group_counts.at[group].xyz;
        offset += uvec2(here.x + here.y, here.y);
    }
    if (local == GROUP_SIZE - 1u) {
        uvec3 all = before + total;
        uint survivors = all.x + all.y;
        FrameCounts result;
        result.visible = all.x;
        result.cutoff = all.y;
        result.invisible = all.z;
        result.culled = FRAME.gaussian_count - survivors - all.z;
        result.project_groups = groups(survivors, SURVIVOR_GROUP_SIZE);
        result.cutoff_groups = groups(all.y, SURVIVOR_GROUP_SIZE);
        // One survivor is sorted too: the passes carry it to the buffer that the draw reads.
        result.sort_groups = uvec4(survivors == 0u ? 0u : FRAME.sort_runs / SORT_GROUP_SIZE, 1u, 1u, 0u);
        result.draw = uvec4(4u, survivors, 0u, 0u);
        result.mesh_groups = groups(survivors, MESH_GROUP_SIZE);
        result.mesh_groups.w = survivors;
        // Binning counts them, where tiles are wanted.
        result.pairs = 0u;
        result.tiled = 0u;
        result.pair_groups = uvec4(0u);
        result.tile_groups = uvec4(0u);
        result.composite = uvec4(0u);
        counts.at[0] = result;
    }
}
