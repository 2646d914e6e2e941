#version 460
#extension GL_GOOGLE_include_directive : require
// The first step of binning for GPUs brings the splats' rectangles of tiles into the order of depth, and finds how many pairs
// with macro-tiles each chunk and each partition of the splats has.
#include "macro_tiles.glsl"
#include "radix.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uvec4, tile_masks)
BUFFER(writeonly, 4, uint, rects)
// Of the partitions; and behind them of their chunks.
BUFFER(writeonly, 5, uint, pair_sums)

shared uint chunk_sums[CHUNKS];

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    if (local < CHUNKS) {
        chunk_sums[local] = 0u;
    }
    barrier();
    uvec2 bounds = partition_bounds(p, KEY_COUNT);
    for (uint chunk = 0u; chunk < CHUNKS; chunk++) {
        uint i = bounds.x + chunk * CHUNK_SPLATS + local;
        if (i < bounds.y) {
            uint splat = order.at[i];
            uint word = RECT_WORD(tile_masks, splat);
            rects.at[i] = word;
            // The sums do not depend on the order.
            atomicAdd(chunk_sums[chunk], word == RECT_LARGE ? pairs_of(rect_of_bounds(tile_masks.at[splat].zw)) : pairs_of_word(word));
        }
    }
    barrier();
    if (local < CHUNKS) {
        pair_sums.at[CHUNK_SUM_PLACE(p, local)] = chunk_sums[local];
    }
    if (local == 0u) {
        uint sum = 0u;
        for (uint chunk = 0u; chunk < CHUNKS; chunk++) {
            sum += chunk_sums[chunk];
        }
        pair_sums.at[p] = sum;
    }
}
