// Macro-tiles of MACRO_COLUMNS x MACRO_ROWS tiles, in which pipelines for GPUs collect the splats before they list those of each
// tile. A splat has a pair with each macro-tile of a rectangle around its tiles, and may touch none of the macro-tile's.
#ifndef RARA_MACRO_TILES
#define RARA_MACRO_TILES
#include "rects.glsl"

// Marks the count of a tile's splats where several surfaces cut one of them.
const uint SEVERAL_TILE = 1u << 31u;

uint macro_columns() {
    return (EYE.tiles.tile_columns + MACRO_COLUMNS - 1u) / MACRO_COLUMNS;
}

uint macro_tile_count() {
    return macro_columns() * ((tile_rows() + MACRO_ROWS - 1u) / MACRO_ROWS);
}

// The macro-tiles that a rectangle of tiles, which is not empty, touches.
Rect macro_rect(Rect tiles) {
    uvec2 sides = uvec2(MACRO_COLUMNS, MACRO_ROWS);
    uvec2 first = tiles.first / sides;
    return Rect(first, (tiles.first + tiles.size - 1u) / sides - first + 1u);
}

// How many pairs a splat has, by its rectangle, and by its rectangle's word, which is not RECT_LARGE.
uint pairs_of(Rect tiles) {
    uvec2 size = tiles.size.x == 0u ? uvec2(0u) : macro_rect(tiles).size;
    return size.x * size.y;
}

uint pairs_of_word(uint word) {
    return word == RECT_NONE ? 0u : pairs_of(rect_of_word(word));
}

// The pairs are counted by chunks of splats, which follow each other in the order of depth, and by partitions of the sort.
const uint CHUNK_SPLATS = RADIX_GROUP_SIZE;
const uint CHUNKS = RADIX_PARTITION / CHUNK_SPLATS;
#define CHUNK_SUM_PLACE(p, chunk) (PARTITIONS + (p) * CHUNKS + (chunk))

// A pair's key is the number of its macro-tile, by which the pairs are sorted; above it is the rectangle of the tiles in the
// macro-tile, which spares most pairs a look at the splat's mask: first column and row, one less than columns and rows.
const uint PAIR_COLUMN_BITS = 4u;
const uint PAIR_ROW_BITS = 3u;
// Marks splats that do not touch all tiles of their rectangle.
const uint PAIR_MASKED = 1u << 31u;

uint pair_key(uvec2 macro_tile, Rect tiles, bool masked) {
    uvec2 corner = macro_tile * uvec2(MACRO_COLUMNS, MACRO_ROWS);
    uvec2 first = max(tiles.first, corner) - corner;
    uvec2 last = min(tiles.first + tiles.size - corner, uvec2(MACRO_COLUMNS, MACRO_ROWS)) - 1u;
    uint place = first.x | first.y << PAIR_COLUMN_BITS;
    uint size = (last.x - first.x) | (last.y - first.y) << PAIR_COLUMN_BITS;
    uint rect = place | size << (PAIR_COLUMN_BITS + PAIR_ROW_BITS);
    return macro_tile.y * macro_columns() + macro_tile.x | rect << PAIR_BITS | (masked ? PAIR_MASKED : 0u);
}

uint pair_macro_tile(uint key) {
    return bitfieldExtract(key, 0, int(PAIR_BITS));
}

// The tiles of a macro-tile, a bit each, row by row: two rows a word.
uvec4 put_row(uvec4 tiles, uint row, uint bits) {
    tiles[row / 2u] |= bits << (row % 2u * MACRO_COLUMNS);
    return tiles;
}

// Those of a pair's rectangle.
uvec4 tiles_of_rect(uint key) {
    uint rect = key >> PAIR_BITS;
    uint column = bitfieldExtract(rect, 0, int(PAIR_COLUMN_BITS));
    uint row = bitfieldExtract(rect, int(PAIR_COLUMN_BITS), int(PAIR_ROW_BITS));
    uint size = rect >> (PAIR_COLUMN_BITS + PAIR_ROW_BITS);
    uint columns = bitfieldExtract(size, 0, int(PAIR_COLUMN_BITS)) + 1u;
    uint rows = bitfieldExtract(size, int(PAIR_COLUMN_BITS), int(PAIR_ROW_BITS)) + 1u;
    uint bits = ((1u << columns) - 1u) << column;
    uvec4 tiles = uvec4(0u);
    for (uint at = 0u; at < MACRO_ROWS; at++) {
        tiles = put_row(tiles, at, at >= row && at < row + rows ? bits : 0u);
    }
    return tiles;
}

// Those that a mask holds. `corner` is the macro-tile's first column and row of tiles.
uvec4 tiles_of_mask(uint origin, uvec2 mask, uvec2 corner) {
    int right = int(origin & 0xffffu) - int(corner.x);
    int down = int(origin >> 16) - int(corner.y);
    uvec4 tiles = uvec4(0u);
    for (uint row = 0u; row < MASK_SIDE; row++) {
        uint bits = bitfieldExtract(row < 4u ? mask.x : mask.y, int(row % 4u * MASK_SIDE), int(MASK_SIDE));
        bits = right >= 0 ? bits << min(right, int(MACRO_COLUMNS)) : bits >> min(-right, int(MASK_SIDE));
        bits &= (1u << MACRO_COLUMNS) - 1u;
        int at = int(row) + down;
        if (at >= 0 && at < int(MACRO_ROWS)) {
            tiles = put_row(tiles, uint(at), bits);
        }
    }
    return tiles;
}

// Those that an outline reaches.
uvec4 tiles_of_outline(Outline o, uvec2 corner) {
    uvec4 tiles = uvec4(0u);
    for (uint row = 0u; row < MACRO_ROWS; row++) {
        if (corner.y + row < o.rows.x || corner.y + row >= o.rows.y) {
            continue;
        }
        uvec2 columns = tiles_in_row(o, corner.y + row);
        uint first = max(columns.x, corner.x) - corner.x;
        uint last = min(max(columns.y, corner.x) - corner.x, MACRO_COLUMNS);
        if (first < last) {
            tiles = put_row(tiles, row, ((1u << (last - first)) - 1u) << first);
        }
    }
    return tiles;
}

#endif
