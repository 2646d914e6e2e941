#version 460
#extension GL_GOOGLE_include_directive : require
// The first step of binning for GPUs finds the macro-tiles of each splat, in the order of depth, and how many pairs each
// partition of the splats has.
#include "macro_tiles.glsl"
#include "radix.glsl"
#include "workgroup_sum.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uvec4, tile_masks)
BUFFER(writeonly, 4, uint, pair_begins)
// The first tile of each splat's rectangle, its column in the lower half; and how many columns and rows of tiles it has,
// marked where the splat does not touch all of them.
BUFFER(writeonly, 5, uint, rect_firsts)
BUFFER(writeonly, 6, uint, rect_sizes)
BUFFER(writeonly, 7, uint, pair_sums)

void main() {
    uvec2 bounds = partition_bounds(gl_WorkGroupID.x, KEY_COUNT);
    uint pairs = 0u;
    for (uint i = bounds.x + gl_LocalInvocationIndex; i < bounds.y; i += RADIX_GROUP_SIZE) {
        uvec4 tiles = tile_masks.at[order.at[i]];
        Rect rect;
        bool masked = true;
        if (tiles.y == 0u) {
            rect = rect_of_mask(tiles.x, tiles.zw);
            masked = uint(bitCount(tiles.z) + bitCount(tiles.w)) != rect.size.x * rect.size.y;
        } else {
            rect = rect_of_bounds(tiles.zw);
        }
        uint count = 0u;
        if (rect.size.x != 0u) {
            uvec2 size = macro_rect(rect).size;
            count = size.x * size.y;
        }
        pair_begins.at[i] = count;
        rect_firsts.at[i] = rect.first.x | rect.first.y << 16;
        rect_sizes.at[i] = rect.size.x | rect.size.y << 16 | (masked ? PAIR_MASKED : 0u);
        pairs += count;
    }
    uint total;
    exclusive_sum(pairs, total);
    if (gl_LocalInvocationIndex == 0u) {
        pair_sums.at[gl_WorkGroupID.x] = total;
    }
}
