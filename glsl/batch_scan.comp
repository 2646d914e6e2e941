#version 460
#extension GL_GOOGLE_include_directive : require
// A workgroup a macro-tile, an invocation a tile, turns the counts of its batches into how many splats of the tile the batches
// before have; and finds how many splats each tile has in all, whether several surfaces cut one of them, and the sums of each
// of the macro-tile's rows of tiles.
#include "batches.glsl"
#include "capped_sum.glsl"

layout(local_size_x = MACRO_TILES) in;

BUFFER(readonly, 2, FrameCounts, counts)
BUFFER(, 3, uint, tile_counts)
BUFFER(writeonly, 4, uint, tile_begins)
// Pairs, tiles that hold anything, and those of them in which several surfaces cut a splat.
BUFFER(writeonly, 5, uvec4, row_sums)

// Batches whose counts an invocation waits for together.
const uint BATCHES_AT_ONCE = 8u;

shared uint totals[MACRO_TILES];

void main() {
    uint macro_tile = LINEAR_GROUP;
    if (macro_tile >= macro_tile_count()) {
        return;
    }
    uint tile = gl_LocalInvocationIndex;
    uint total = 0u;
    uint mark = 0u;
    // Without pairs no macro-tile's beginning is known.
    if (counts.at[0].macro_pairs > 0u) {
        uint first = first_batch(macro_tile);
        uint end = first + batches_of(macro_tile);
        for (uint batch = first; batch < end; batch += BATCHES_AT_ONCE) {
            uint own[BATCHES_AT_ONCE];
            for (uint k = 0u; k < BATCHES_AT_ONCE; k++) {
                uint count = tile_counts.at[tile_count_place(min(batch + k, end - 1u), tile)];
                own[k] = batch + k < end ? count : 0u;
            }
            for (uint k = 0u; k < BATCHES_AT_ONCE; k++) {
                if (batch + k < end) {
                    tile_counts.at[tile_count_place(batch + k, tile)] = total;
                }
                total += own[k] & ~SEVERAL_TILE;
                mark |= own[k] & SEVERAL_TILE;
            }
        }
    }
    totals[tile] = total | mark;
    barrier();
    uvec2 corner = corner_of(macro_tile);
    uvec2 at = corner + uvec2(tile % MACRO_COLUMNS, tile / MACRO_COLUMNS);
    if (at.x < EYE.tiles.tile_columns && at.y < tile_rows()) {
        tile_begins.at[at.y * EYE.tiles.tile_columns + at.x] = total | mark;
    }
    if (tile < MACRO_ROWS && corner.y + tile < tile_rows()) {
        uvec4 sum = uvec4(0u);
        for (uint column = 0u; column < MACRO_COLUMNS; column++) {
            uint here = totals[tile * MACRO_COLUMNS + column];
            sum.x = capped_sum(sum.x, here & ~SEVERAL_TILE);
            sum.y += here != 0u ? 1u : 0u;
            sum.z += here >= SEVERAL_TILE ? 1u : 0u;
        }
        row_sums.at[(corner.y + tile) * macro_columns() + corner.x / MACRO_COLUMNS] = sum;
    }
}
