#version 460
#extension GL_GOOGLE_include_directive : require
// The fifth step of binning, one invocation a row of tiles, finds where the splats of each tile begin, and those of each
// part in it.
#include "coarse.glsl"
#include "rows.glsl"

layout(local_size_x = ROW_GROUP_SIZE) in;

BUFFER(writeonly, 3, uint, tile_begins)

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= tile_rows()) {
        return;
    }
    uint place = 0u;
    for (uint part = 0u; part < row * EYE.tiles.row_parts; part++) {
        place += column_counts.at[columns_place(part) + EYE.tiles.tile_columns];
    }
    for (uint column = 0u; column < EYE.tiles.tile_columns; column++) {
        tile_begins.at[row * EYE.tiles.tile_columns + column] = place;
        for (uint part = row * EYE.tiles.row_parts; part < (row + 1u) * EYE.tiles.row_parts; part++) {
            uint count = column_counts.at[columns_place(part) + column];
            column_counts.at[columns_place(part) + column] = place;
            place += count;
        }
    }
    if (row + 1u == tile_rows()) {
        tile_begins.at[EYE.tiles.tile_count] = place;
        tile_begins.at[cell_side_place()] = 0u;
    }
}
