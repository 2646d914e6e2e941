#version 460
#extension GL_GOOGLE_include_directive : require
// The first step of binning counts how many spans each run of the sorted splats has in each row of tiles. A span is the
// tiles of one row that a splat touches. A run's counts lie together, one run after the other; behind them all is how many
// tiles each run touches.
#include "bin.glsl"

layout(local_size_x = SPAN_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, vec4, splats)
BUFFER(readonly, 3, uint, order)
BUFFER(, 4, uint, span_counts)
BUFFER(readonly, 5, uvec4, tile_masks)
// The masks or bounds once more, in the order of depth, for the third step, in buffers that the sort no longer needs.
BUFFER(writeonly, 6, uint, mask_origins)
BUFFER(writeonly, 7, uint, masks_above)
BUFFER(writeonly, 8, uint, masks_below)
#include "splat_at.glsl"

// Splats lie apart in memory: an invocation asks for the masks of so many at once, by a word of each.
const uint AHEAD = 8u;

void main() {
    uint run = gl_GlobalInvocationID.x;
    uint rows = tile_rows();
    for (uint row = 0u; row < rows; row++) {
        span_counts.at[run * rows + row] = 0u;
    }
    uvec2 bounds = run_bounds(run, EYE.tiles.span_runs, counts.at[0].visible + counts.at[0].cutoff);
    uint found = 0u;
    // Pairs beyond the room need no counting: the lists are coarse, and the next frame has more room.
    uint splats_ahead[AHEAD];
    uint ahead_x[AHEAD];
    for (uint i = bounds.x; i < bounds.y && found <= EYE.room.pair_capacity; i++) {
        uint turn = (i - bounds.x) % AHEAD;
        if (turn == 0u) {
            for (uint k = 0u; k < AHEAD; k++) {
                splats_ahead[k] = order.at[min(i + k, bounds.y - 1u)];
            }
            for (uint k = 0u; k < AHEAD; k++) {
                ahead_x[k] = tile_masks.at[splats_ahead[k]].x;
            }
        }
        uint splat = splats_ahead[turn];
        uvec4 tiles = uvec4(ahead_x[turn], tile_masks.at[splat].yzw);
        mask_origins.at[i] = tiles.y == 0u ? tiles.x : NO_MASK;
        masks_above.at[i] = tiles.z;
        masks_below.at[i] = tiles.w;
        for (uvec2 mask = tiles.y == 0u ? tiles.zw : uvec2(0u); (mask.x | mask.y) != 0u;) {
            Span span = next_span(tiles.x, mask);
            span_counts.at[run * rows + span.row]++;
            found += span.columns.y - span.columns.x;
        }
        if (tiles.y == 0u) {
            continue;
        }
        Outline o = bounded_outline(splat_at(splat), tiles.zw);
        for (uint row = o.rows.x; row < o.rows.y; row++) {
            uvec2 columns = tiles_in_row(o, row);
            span_counts.at[run * rows + row] += columns.x < columns.y ? 1u : 0u;
            found += columns.y - columns.x;
        }
    }
    span_counts.at[pairs_place(run)] = found;
}
