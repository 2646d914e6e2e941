#version 460
#extension GL_GOOGLE_include_directive : require
// A workgroup a row of tiles finds where the splats of each of its tiles begin, and lists the tiles that hold any: first those
// that need no code for several surfaces, and from the list's end on the others. Where not all pairs have room, the workgroups
// write coarse lists instead.
#include "macro_tiles.glsl"
#include "workgroup_sum.glsl"
#include "groups.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

// True where tiles that need code for several surfaces are drawn by themselves. Without room that is all of them.
layout(constant_id = 0) const bool SEVERAL = false;

BUFFER(, 1, FrameCounts, counts)
BUFFER(readonly, 2, uvec4, row_sums)
BUFFER(, 3, uint, tile_begins)
BUFFER(writeonly, 4, uint, tile_list)
BUFFER(readonly, 5, uint, order)
BUFFER(readonly, 6, uvec4, tile_masks)
BUFFER(writeonly, 7, uint, tile_splats)
#include "room.glsl"
const bool RECTS = true;
#include "coarse_lists.glsl"

shared uvec3 row_totals[RADIX_GROUP_SIZE];
shared uvec3 totals_of_rows[SUM_ROWS];

// The sums over all invocations.
uvec3 totals_of(uvec3 values) {
    uint local = gl_LocalInvocationIndex;
    row_totals[local] = values;
    barrier();
    if (local < SUM_ROWS) {
        uvec3 sum = uvec3(0u);
        for (uint i = 0u; i < SUM_ROW; i++) {
            sum += row_totals[i * SUM_ROWS + local];
        }
        totals_of_rows[local] = sum;
    }
    barrier();
    uvec3 totals = uvec3(0u);
    for (uint i = 0u; i < SUM_ROWS; i++) {
        totals += totals_of_rows[i];
    }
    return totals;
}

// A tile in one of two counts that share a word: of the tiles that need no code for several surfaces, and of the others.
uint kind_of(uint marked_count) {
    return marked_count >= SEVERAL_TILE ? 1u << 16u : marked_count != 0u ? 1u : 0u;
}

void write_commands(uint pairs, uint filled, uint several) {
    bool has_room = decide_room(pairs);
    tile_begins.at[EYE.tiles.tile_count] = has_room ? pairs : EYE.tiles.tile_count;
    tile_begins.at[cell_side_place()] = has_room ? 0u : EYE.room.cell_side;
    tile_begins.at[cell_words_place()] = coarse_words();
    if (!has_room) {
        filled = EYE.tiles.tile_count;
        several = SEVERAL ? filled : 0u;
    }
    tile_list.at[EYE.tiles.tile_count] = filled - several;
    tile_list.at[EYE.tiles.tile_count + 1u] = several;
    counts.at[0].tile_groups = groups(filled - several, 1u);
    counts.at[0].several_tile_groups = groups(several, 1u);
}

// The row's part of coarse lists, in which all tiles are listed in their order.
void write_coarse(uint row) {
    uint end = (counts.at[0].mesh_groups.w + COARSE_GROUP_SIZE - 1u) / COARSE_GROUP_SIZE;
    for (uint group = row; group < end; group += tile_rows()) {
        write_coarse_lists(group);
        barrier();
    }
    for (uint column = gl_LocalInvocationIndex; column < EYE.tiles.tile_columns; column += COARSE_GROUP_SIZE) {
        uint tile = row * EYE.tiles.tile_columns + column;
        tile_begins.at[tile] = tile;
        tile_list.at[tile] = tile;
    }
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint row = gl_WorkGroupID.x;
    uvec3 my_before = uvec3(0u);
    uvec3 my_all = uvec3(0u);
    for (uint i = local; i < tile_rows() * macro_columns(); i += RADIX_GROUP_SIZE) {
        uvec3 sum = row_sums.at[i].xyz;
        my_before += i < row * macro_columns() ? sum : uvec3(0u);
        my_all = uvec3(capped_sum(my_all.x, sum.x), my_all.yz + sum.yz);
    }
    // Where the macro-tiles' pairs had no room, it is known already how many are needed.
    uint pairs = max(capped_total(my_all.x), counts.at[0].excess_pairs);
    if (row == 0u) {
        uvec3 all = totals_of(my_all);
        if (local == 0u) {
            write_commands(pairs, all.y, all.z);
        }
    }
    if (pairs > EYE.room.pair_capacity) {
        write_coarse(row);
        return;
    }
    uvec3 before = totals_of(my_before);
    uint place = before.x;
    uint several = before.z;
    uint few = before.y - several;
    for (uint first = 0u; first < EYE.tiles.tile_columns; first += RADIX_GROUP_SIZE) {
        uint column = first + local;
        uint tile = row * EYE.tiles.tile_columns + column;
        bool is_tile = column < EYE.tiles.tile_columns;
        uint count = is_tile ? tile_begins.at[tile] : 0u;
        uint kind = kind_of(count);
        uint total;
        uint kinds;
        uint pairs_before = exclusive_sum(count & ~SEVERAL_TILE, total);
        uint kinds_before = exclusive_sum(kind, kinds);
        if (is_tile) {
            tile_begins.at[tile] = place + pairs_before;
        }
        if (kind == 1u) {
            tile_list.at[few + (kinds_before & 0xffffu)] = tile;
        } else if (kind != 0u) {
            tile_list.at[EYE.tiles.tile_count - 1u - several - (kinds_before >> 16u)] = tile;
        }
        place += total;
        few += kinds & 0xffffu;
        several += kinds >> 16u;
    }
}
