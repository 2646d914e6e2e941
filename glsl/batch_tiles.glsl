// The tiles of a batch's splats: for each tile of the macro-tile, a bit for each splat of the batch. Included by workgroups of
// RADIX_GROUP_SIZE, which say whether they need the splats' numbers in any case, NEEDS_SPLATS.
#ifndef RARA_BATCH_TILES
#define RARA_BATCH_TILES
#include "batches.glsl"

BUFFER(readonly, 2, FrameCounts, counts)
BUFFER(readonly, 3, vec4, splats)
BUFFER(readonly, 4, uvec4, tile_masks)
BUFFER(readonly, 5, uint, macro_splats)
BUFFER(readonly, 6, uint, macro_keys)
#include "splat_at.glsl"

const uint BATCH_WORDS = BATCH_SPLATS / 32u;
// The words of a tile are this far apart, so that neither the words of one tile nor those of neighbours share a memory bank.
const uint HELD_STRIDE = MACRO_TILES + 1u;

shared uint held[BATCH_WORDS * HELD_STRIDE];
shared uint batch_splats[BATCH_SPLATS];

uint held_place(uint word, uint tile) {
    return word * HELD_STRIDE + tile;
}

uvec4 tiles_of(uint pair, uvec2 corner) {
    uint key = macro_keys.at[pair];
    if (key < PAIR_MASKED) {
        return tiles_of_rect(key);
    }
    uint splat = macro_splats.at[pair];
    uvec4 tiles = tile_masks.at[splat];
    if (tiles.y == 0u) {
        return tiles_of_mask(tiles.x, tiles.zw, corner);
    }
    return tiles_of_outline(bounded_outline(splat_at(splat), tiles.zw), corner);
}

void find_held(Batch batch) {
    uint local = gl_LocalInvocationIndex;
    for (uint i = local; i < BATCH_WORDS * HELD_STRIDE; i += RADIX_GROUP_SIZE) {
        held[i] = 0u;
    }
    barrier();
    uvec2 corner = corner_of(batch.macro_tile);
    for (uint i = local; i < batch.pairs.y - batch.pairs.x; i += RADIX_GROUP_SIZE) {
        if (NEEDS_SPLATS) {
            batch_splats[i] = macro_splats.at[batch.pairs.x + i];
        }
        uvec4 tiles = tiles_of(batch.pairs.x + i, corner);
        for (uint word = 0u; word < 4u; word++) {
            for (uint bits = tiles[word]; bits != 0u; bits &= bits - 1u) {
                // Bits may be set in any order.
                atomicOr(held[held_place(i / 32u, word * 32u + uint(findLSB(bits)))], 1u << i % 32u);
            }
        }
    }
    barrier();
}

#endif
