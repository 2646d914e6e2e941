#version 460
#extension GL_GOOGLE_include_directive : require
// Last step of binning: where each tile's pairs begin. A run fills in the tiles up to the one of each of its pairs, so
// that empty tiles begin where the next one does.
#include "sort.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, pair_tiles)
BUFFER(writeonly, 3, uint, tile_begins)

void main() {
    uint run = gl_GlobalInvocationID.x;
    uint pairs = counts.at[0].pairs;
    uvec2 bounds = run_bounds(run, pairs);
    uint next = bounds.x == 0u ? 0u : pair_tiles.at[bounds.x - 1u] + 1u;
    for (uint i = bounds.x; i < bounds.y; i++) {
        for (uint tile = min(pair_tiles.at[i], FRAME.tile_count - 1u); next <= tile; next++) {
            tile_begins.at[next] = i;
        }
    }
    bool last = bounds.y == pairs && (bounds.x < bounds.y || (pairs == 0u && run == 0u));
    for (; last && next <= FRAME.tile_count; next++) {
        tile_begins.at[next] = pairs;
    }
}
