#version 460
#extension GL_GOOGLE_include_directive : require
// The fourth step of binning counts how many spans of each part of a row hold each of its tiles. A span is noted where it
// begins and where it has ended, whatever its length; sums along the row make counts of that.
#include "rows.glsl"

layout(local_size_x = ROW_GROUP_SIZE) in;

BUFFER(readonly, 3, uint, span_columns)

void main() {
    uint part = gl_GlobalInvocationID.x;
    if (part >= part_count()) {
        return;
    }
    uint first = columns_place(part);
    for (uint column = 0u; column <= EYE.tiles.tile_columns; column++) {
        column_counts.at[first + column] = 0u;
    }
    uvec2 bounds = part_bounds(part);
    for (uint i = bounds.x; i < bounds.y; i++) {
        uvec2 columns = columns_of(span_columns.at[i]);
        column_counts.at[first + columns.x]++;
        column_counts.at[first + columns.y]--;
    }
    uint here = 0u;
    uint pairs = 0u;
    for (uint column = 0u; column < EYE.tiles.tile_columns; column++) {
        here += column_counts.at[first + column];
        column_counts.at[first + column] = here;
        pairs += here;
    }
    column_counts.at[first + EYE.tiles.tile_columns] = pairs;
}
