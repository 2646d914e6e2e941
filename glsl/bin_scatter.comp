#version 460
#extension GL_GOOGLE_include_directive : require
// Third step of binning: each run writes its pairs of tile and splat, front to back, to the places of their lowest digit.
#include "bin.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, Splat, splats)
BUFFER(readonly, 3, uint, order)
BUFFER(, 4, uint, histogram)
BUFFER(writeonly, 5, uint, pair_tiles)
BUFFER(writeonly, 6, uint, pair_splats)
BUFFER(readonly, 7, uint, mask_origins)
BUFFER(readonly, 8, uint, masks_above)
BUFFER(readonly, 9, uint, masks_below)

void put(uint run, uint tile, uint splat) {
    uint slot = run * DIGITS + digit(tile, 0u);
    uint place = histogram.at[slot];
    histogram.at[slot] = place + 1u;
    if (place >= counts.at[0].pairs) {
        return; // cannot be, while both steps find the same tiles
    }
    pair_tiles.at[place] = tile;
    pair_splats.at[place] = splat;
}

void main() {
    uint run = gl_GlobalInvocationID.x;
    uvec2 bounds = run_bounds(run, counts.at[0].visible + counts.at[0].cutoff);
    for (uint i = bounds.x; i < bounds.y; i++) {
        uint splat = order.at[i];
        uint origin = mask_origins.at[i];
        for (uvec2 mask = uvec2(masks_above.at[i], masks_below.at[i]); (mask.x | mask.y) != 0u;) {
            put(run, next_tile(origin, mask), splat);
        }
        if (origin != NO_MASK) {
            continue;
        }
        Outline o = outline(splats.at[splat]);
        for (uint row = o.rows.x; row < o.rows.y; row++) {
            uvec2 columns = tiles_in_row(o, row) + row * FRAME.tile_columns;
            for (uint tile = columns.x; tile < columns.y; tile++) {
                put(run, tile, splat);
            }
        }
    }
}
