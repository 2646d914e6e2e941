#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the blocks' totals to the frame's counts, finds each block's place in the lists of what changes and of what is cut, and
// writes their indirect commands. The splats and their order stay.
#include "block_runs.glsl"
#include "reclip.glsl"
#include "groups.glsl"

BUFFER(readonly, 1, uint, revisits)
BUFFER(, 2, uint, reclips)
BUFFER(writeonly, 3, FrameCounts, counts)

uvec4 totals_of(uint block) {
    uint base = block * RECLIP_WORDS + RECLIP_TOTALS;
    uint changed = is_revisited(revisits.at[block]) ? reclips.at[base + 3u] : 0u;
    return uvec4(reclips.at[base], reclips.at[base + 1u], reclips.at[base + 2u], changed);
}

void main() {
    BlockRun run = block_run();
    uvec4 place = run.before;
    for (uint block = run.bounds.x; block < run.bounds.y; block++) {
        uint base = block * RECLIP_WORDS + RECLIP_PLACES;
        reclips.at[base] = place.w;
        reclips.at[base + 1u] = place.y;
        place += totals_of(block);
    }
    if (run.is_last) {
        counts.at[0].visible = place.x;
        counts.at[0].cutoff = place.y;
        counts.at[0].long_records = 0u;
        counts.at[0].long_strides = 0u;
        counts.at[0].invisible = place.z;
        counts.at[0].cutoff_groups = groups(place.y, SPLAT_GROUP_SIZE);
        counts.at[0].recut_groups = groups(place.w, SPLAT_GROUP_SIZE);
    }
}
