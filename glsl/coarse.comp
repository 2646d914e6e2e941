#version 460
#extension GL_GOOGLE_include_directive : require
// The last step of binning writes coarse lists where those of the tiles have no room, one invocation a splat in the order of depth.
// All tiles count as filled then.
#include "frame.glsl"

layout(local_size_x = COARSE_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uvec4, tile_masks)
BUFFER(writeonly, 4, uint, tile_splats)
BUFFER(writeonly, 5, uint, tile_begins)
const bool RECTS = false;
#include "coarse_lists.glsl"

void main() {
    write_coarse_lists(LINEAR_GROUP);
    uint place = LINEAR_GROUP * COARSE_GROUP_SIZE + gl_LocalInvocationIndex;
    uint invocations = counts.at[0].coarse_groups.x * counts.at[0].coarse_groups.y * COARSE_GROUP_SIZE;
    for (uint tile = place; tile <= EYE.tiles.tile_count; tile += invocations) {
        tile_begins.at[tile] = tile;
    }
    if (place == 0u) {
        tile_begins.at[cell_side_place()] = EYE.room.cell_side;
        tile_begins.at[cell_words_place()] = coarse_words();
    }
}
