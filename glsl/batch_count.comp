#version 460
#extension GL_GOOGLE_include_directive : require
// Counts how many splats of each batch are in each tile of its macro-tile.
#include "batch_tiles.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(writeonly, 6, uint, tile_counts)

void main() {
    uint number = LINEAR_GROUP;
    if (number >= counts.at[0].batch_groups.w) {
        return;
    }
    Batch batch = batch_of(number);
    if (batch.pairs.x == batch.pairs.y) {
        return;
    }
    find_held(batch);
    uint tile = gl_LocalInvocationIndex;
    if (tile < MACRO_TILES) {
        uint count = 0u;
        for (uint word = 0u; word < BATCH_WORDS; word++) {
            count += bitCount(held[held_place(word, tile)]);
        }
        tile_counts.at[tile_count_place(number, tile)] = count;
    }
}
