#version 460
#extension GL_GOOGLE_include_directive : require
// A workgroup a row of tiles finds where the splats of each of its tiles begin. The first one finds whether all have room.
#include "macro_tiles.glsl"
#include "workgroup_sum.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, row_sums)
BUFFER(, 3, uint, tile_begins)
#include "room.glsl"

void main() {
    uint local = gl_LocalInvocationIndex;
    uint row = gl_WorkGroupID.x;
    uint my_before = 0u;
    uint my_all = 0u;
    for (uint i = local; i < tile_rows() * macro_columns(); i += RADIX_GROUP_SIZE) {
        uint sum = row_sums.at[i];
        my_before += i < row * macro_columns() ? sum : 0u;
        my_all = capped_sum(my_all, sum);
    }
    uint all = capped_total(my_all);
    uint before;
    exclusive_sum(my_before, before);
    for (uint first = 0u; first < FRAME.tiles.tile_columns; first += RADIX_GROUP_SIZE) {
        uint column = first + local;
        bool is_tile = column < FRAME.tiles.tile_columns;
        uint place = row * FRAME.tiles.tile_columns + column;
        uint total;
        uint sum = exclusive_sum(is_tile ? tile_begins.at[place] : 0u, total);
        if (is_tile) {
            tile_begins.at[place] = before + sum;
        }
        before += total;
    }
    if (row == 0u && local == 0u) {
        tile_begins.at[FRAME.tiles.tile_count] = all;
        // Where the macro-tiles' pairs had no room, it is known already how many are needed.
        decide_room(max(all, counts.at[0].pairs));
    }
}
