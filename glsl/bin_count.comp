#version 460
#extension GL_GOOGLE_include_directive : require
// First step of binning: how often each run of the sorted splats touches tiles of each lowest digit. It is the first
// step of sorting the pairs of tile and splat by tile, which need not exist for it.
#include "bin.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, Splat, splats)
BUFFER(readonly, 3, uint, order)
BUFFER(, 4, uint, histogram)

void main() {
    uint run = gl_GlobalInvocationID.x;
    for (uint d = 0u; d < DIGITS; d++) {
        histogram.at[run * DIGITS + d] = 0u;
    }
    uvec2 bounds = run_bounds(run, counts.at[0].visible + counts.at[0].cutoff);
    for (uint i = bounds.x; i < bounds.y; i++) {
        Outline o = outline(splats.at[order.at[i]]);
        for (uint row = o.rows.x; row < o.rows.y; row++) {
            uvec2 columns = tiles_in_row(o, row) + row * FRAME.tile_columns;
            for (uint tile = columns.x; tile < columns.y; tile++) {
                histogram.at[run * DIGITS + digit(tile)]++;
            }
        }
    }
}
