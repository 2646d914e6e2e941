// Coarse lists, which stand in for those of the tiles where these have no room. The picture is divided into square cells of tiles,
// as small as the room allows. Each row of cells and each column of them has a bit for each splat, by depth, which says whether the
// splat may touch it: those of a cell have both bits. They lie in the place of the tiles' lists: the splats by depth, 32 words for
// each word of bits, then the bits of each row, and of each column.
#ifndef RARA_COARSE
#define RARA_COARSE
#include "frame.glsl"

// Behind the tiles' begins is how many tiles a cell has along a side, 0 where each tile has a list of its own,
uint cell_side_place() {
    return EYE.tiles.tile_count + 1u;
}

// and how many words of bits a row or a column of cells has.
uint cell_words_place() {
    return EYE.tiles.tile_count + 2u;
}

// Columns and rows of cells.
uvec2 cell_counts(uint side) {
    return (uvec2(EYE.tiles.tile_columns, tile_rows()) + side - 1u) / side;
}

// Where the bits of the first row of cells begin.
uint cell_bits_place(uint words) {
    return 32u * words;
}

#endif
