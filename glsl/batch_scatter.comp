#version 460
#extension GL_GOOGLE_include_directive : require
// The last step of binning for GPUs writes the splats of each batch, front to back, to the places of their tiles.
#define NEEDS_SPLATS true
#include "batch_tiles.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 7, uint, tile_counts)
BUFFER(readonly, 8, uint, tile_begins)
BUFFER(writeonly, 9, uint, tile_splats)

// Where the first splat of each word goes.
shared uint places[BATCH_WORDS * HELD_STRIDE];

void main() {
    uint number = LINEAR_GROUP;
    if (number >= counts.at[0].batch_groups.w || counts.at[0].has_room == 0u) {
        return;
    }
    Batch batch = batch_of(number);
    if (batch.pairs.x == batch.pairs.y) {
        return;
    }
    find_held(batch);
    uint local = gl_LocalInvocationIndex;
    uvec2 at = corner_of(batch.macro_tile) + uvec2(local % MACRO_COLUMNS, local / MACRO_COLUMNS);
    if (local < MACRO_TILES && at.x < EYE.tiles.tile_columns && at.y < tile_rows()) {
        uint place = tile_begins.at[at.y * EYE.tiles.tile_columns + at.x] + tile_counts.at[tile_count_place(number, local)];
        for (uint word = 0u; word < BATCH_WORDS; word++) {
            places[held_place(word, local)] = place;
            place += bitCount(held[held_place(word, local)]);
        }
    }
    barrier();
    uint pairs = counts.at[0].pairs;
    // Neighbouring invocations have the words of one tile, whose splats go to neighbouring places.
    for (uint i = local; i < BATCH_WORDS * MACRO_TILES; i += RADIX_GROUP_SIZE) {
        uint word = i % BATCH_WORDS;
        uint slot = held_place(word, i / BATCH_WORDS);
        uint place = places[slot];
        for (uint bits = held[slot]; bits != 0u; bits &= bits - 1u) {
            if (place < pairs) { // it is, while both steps find the same tiles
                tile_splats.at[place] = batch_splats[word * 32u + uint(findLSB(bits))];
            }
            place++;
        }
    }
}
