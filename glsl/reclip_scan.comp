#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup sums the blocks' totals to the frame's counts, finds each block's place in the lists of what changes and of
// what is cut, and writes their indirect commands. The survivors and their order stay.
#include "reclip.glsl"
#include "groups.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER(readonly, 1, uint, revisits)
BUFFER(, 2, uint, reclips)
BUFFER(writeonly, 3, FrameCounts, counts)

shared uvec4 run_totals[BLOCK_SIZE];

uvec4 totals_of(uint block) {
    uint base = block * RECLIP_WORDS + RECLIP_TOTALS;
    uint changed = is_revisited(revisits.at[block]) ? reclips.at[base + 3u] : 0u;
    return uvec4(reclips.at[base], reclips.at[base + 1u], reclips.at[base + 2u], changed);
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint run = (FRAME.scene.block_count + BLOCK_SIZE - 1u) / BLOCK_SIZE;
    uint begin = min(local * run, FRAME.scene.block_count);
    uint end = min(begin + run, FRAME.scene.block_count);
    uvec4 total = uvec4(0u);
    for (uint block = begin; block < end; block++) {
        total += totals_of(block);
    }
    run_totals[local] = total;
    barrier();
    uvec4 place = uvec4(0u);
    for (uint other = 0u; other < local; other++) {
        place += run_totals[other];
    }
    for (uint block = begin; block < end; block++) {
        uint base = block * RECLIP_WORDS + RECLIP_PLACES;
        reclips.at[base] = place.w;
        reclips.at[base + 1u] = place.y;
        place += totals_of(block);
    }
    if (local == BLOCK_SIZE - 1u) {
        counts.at[0].visible = place.x;
        counts.at[0].cutoff = place.y;
        counts.at[0].invisible = place.z;
        counts.at[0].cutoff_groups = groups(place.y, SURVIVOR_GROUP_SIZE);
        counts.at[0].recut_groups = groups(place.w, SURVIVOR_GROUP_SIZE);
    }
}
