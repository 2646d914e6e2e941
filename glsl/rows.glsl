// The spans of a row of tiles, which are front to back, are divided into parts, one for each invocation.
#ifndef RARA_ROWS
#define RARA_ROWS
#include "frame.glsl"

BUFFER(readonly, 1, uint, row_begins)
// For each part, how many of its spans hold each column, or where its splats go, and then the number of its pairs.
BUFFER(, 2, uint, column_counts)

uint part_count() {
    return tile_rows() * EYE.tiles.row_parts;
}

// The place where the counts of a part's columns begin.
uint columns_place(uint part) {
    return part * (EYE.tiles.tile_columns + 1u);
}

// First and last span (exclusive) of a part.
uvec2 part_bounds(uint part) {
    uint row = part / EYE.tiles.row_parts;
    uint begin = row_begins.at[row];
    uint end = row_begins.at[row + 1u];
    uint size = (end - begin + EYE.tiles.row_parts - 1u) / EYE.tiles.row_parts;
    begin = min(begin + part % EYE.tiles.row_parts * size, end);
    return uvec2(begin, min(begin + size, end));
}

// First and last column (exclusive) of a span, limited to the row.
uvec2 columns_of(uint span) {
    return min(uvec2(span & 0xffffu, span >> 16), EYE.tiles.tile_columns);
}

#endif
