#version 460
#extension GL_GOOGLE_include_directive : require
// After the sort of the pairs of macro-tile and splat this finds where those of each macro-tile begin. One that has none begins
// where the next one does.
#include "macro_tiles.glsl"
#define KEY_COUNT counts.at[0].macro_pairs
#include "radix.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, macro_keys)
BUFFER(writeonly, 3, uint, macro_begins)

void main() {
    uint count = KEY_COUNT;
    uvec2 bounds = partition_bounds(gl_WorkGroupID.x, count);
    for (uint i = bounds.x + gl_LocalInvocationIndex; i < bounds.y; i += RADIX_GROUP_SIZE) {
        uint key = pair_macro_tile(macro_keys.at[i]);
        uint first = i == 0u ? 0u : pair_macro_tile(macro_keys.at[i - 1u]) + 1u;
        for (uint macro_tile = first; macro_tile <= key; macro_tile++) {
            macro_begins.at[macro_tile] = i;
        }
        if (i + 1u == count) {
            for (uint macro_tile = key + 1u; macro_tile <= macro_tile_count(); macro_tile++) {
                macro_begins.at[macro_tile] = count;
            }
        }
    }
}
