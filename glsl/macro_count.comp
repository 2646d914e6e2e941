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
    for (uint first = 0u; first < CHUNKS; first += KEYS_AT_ONCE) {
        uint own[KEYS_AT_ONCE]; // splats
        uint words[KEYS_AT_ONCE];
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            own[k] = order.at[min(bounds.x + (first + k) * CHUNK_SPLATS + local, bounds.y - 1u)];
        }
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            words[k] = RECT_WORD(tile_masks, own[k]);
        }
        for (uint k = 0u; k < KEYS_AT_ONCE; k++) {
            uint i = bounds.x + (first + k) * CHUNK_SPLATS + local;
            if (i < bounds.y) {
                bool is_large = words[k] == RECT_LARGE;
                rects.at[i] = words[k];
                // The sums do not depend on the order.
                atomicAdd(chunk_sums[first + k], is_large ? pairs_of(rect_of_bounds(tile_masks.at[own[k]].zw)) : pairs_of_word(words[k]));
            }
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
