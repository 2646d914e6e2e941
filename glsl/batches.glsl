// Batches of splats of one macro-tile, front to back, a workgroup each. The pairs of all macro-tiles are divided into pieces of
// BATCH_SPLATS; a batch is the part of a piece that is of one macro-tile. Its number is that of the piece and of the macro-tile
// added, so that no two batches have the same one and those of a macro-tile follow each other, in their order.
#ifndef RARA_BATCHES
#define RARA_BATCHES
#include "macro_tiles.glsl"

BUFFER(readonly, 1, uint, macro_begins)

struct Batch {
    uint macro_tile;
    uvec2 pairs; // first and last (exclusive); none where no batch has the number
};

uint first_batch(uint macro_tile) {
    return macro_tile + macro_begins.at[macro_tile] / BATCH_SPLATS;
}

Batch batch_of(uint number) {
    // The last macro-tile whose batches do not begin behind the number.
    uint macro_tile = 0u;
    uint end = macro_tile_count();
    while (macro_tile + 1u < end) {
        uint middle = (macro_tile + end) / 2u;
        if (first_batch(middle) <= number) {
            macro_tile = middle;
        } else {
            end = middle;
        }
    }
    uint begin = (number - macro_tile) * BATCH_SPLATS;
    uvec2 pairs = uvec2(macro_begins.at[macro_tile], macro_begins.at[macro_tile + 1u]);
    return Batch(macro_tile, clamp(uvec2(begin, begin + BATCH_SPLATS), pairs.xx, pairs.yy));
}

// How many batches a macro-tile has.
uint batches_of(uint macro_tile) {
    uvec2 pairs = uvec2(macro_begins.at[macro_tile], macro_begins.at[macro_tile + 1u]);
    return pairs.x == pairs.y ? 0u : (pairs.y - 1u) / BATCH_SPLATS - pairs.x / BATCH_SPLATS + 1u;
}

// The first column and row of tiles of a macro-tile.
uvec2 corner_of(uint macro_tile) {
    return uvec2(macro_tile % macro_columns(), macro_tile / macro_columns()) * uvec2(MACRO_COLUMNS, MACRO_ROWS);
}

// The place of the count of a batch's splats in a tile of its macro-tile.
uint tile_count_place(uint batch, uint tile) {
    return batch * MACRO_TILES + tile;
}

#endif
