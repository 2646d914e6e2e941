// Rectangles of tiles. Pipelines for GPUs know most splats' tiles by a word: the rectangle around them, marked where the splat
// does not touch all of it. Only then is the mask of its tiles written, or read. The words stand behind the masks, four in the
// place of one.
#ifndef RARA_RECTS
#define RARA_RECTS
#include "bin.glsl"

// A rectangle of tiles.
struct Rect {
    uvec2 first; // column and row
    uvec2 size; // columns and rows, 0 for none
};

const Rect NO_RECT = Rect(uvec2(0u), uvec2(0u));

Rect rect_between(uvec2 columns, uvec2 rows) {
    if (columns.x >= columns.y || rows.x >= rows.y) {
        return NO_RECT;
    }
    return Rect(uvec2(columns.x, rows.x), uvec2(columns.y - columns.x, rows.y - rows.x));
}

// The rectangle around the tiles of a mask (tile_mask).
Rect rect_of_mask(uint origin, uvec2 mask) {
    uint both = mask.x | mask.y;
    if (both == 0u) {
        return NO_RECT;
    }
    uint columns = both | both >> 16;
    columns = (columns | columns >> 8) & 0xffu;
    uint first_bit = mask.x != 0u ? uint(findLSB(mask.x)) : 32u + uint(findLSB(mask.y));
    uint last_bit = mask.y != 0u ? 32u + uint(findMSB(mask.y)) : uint(findMSB(mask.x));
    uvec2 first = uvec2(origin & 0xffffu, origin >> 16);
    return rect_between(first.x + uvec2(findLSB(columns), findMSB(columns) + 1),
        first.y + uvec2(first_bit / MASK_SIDE, last_bit / MASK_SIDE + 1u));
}

// That around the tiles of an outline, from its bounds.
Rect rect_of_bounds(uvec2 bounds) {
    vec2 sides = sides_of(bounds);
    return rect_between(tiles_between(sides.x, sides.y, VIEW.size.x, TILE_WIDTH), rows_of(bounds));
}

// A rectangle's word: first column and row, one less than columns and rows. Pictures have up to 4096 tiles a side.
const int RECT_PLACE_BITS = 12;
const int RECT_SIZE_BITS = 3;
// Marks splats that do not touch all tiles of their rectangle.
const uint RECT_MASKED = 1u << 30u;
// Stands for those whose rectangle is larger than a mask.
const uint RECT_LARGE = 1u << 31u;
// Stands for those without tiles.
const uint RECT_NONE = ~0u;

// The word of a splat's mask.
uint rect_word(uvec4 tiles) {
    if (tiles.y != 0u) {
        return RECT_LARGE;
    }
    Rect rect = rect_of_mask(tiles.x, tiles.zw);
    if (rect.size.x == 0u) {
        return RECT_NONE;
    }
    bool masked = uint(bitCount(tiles.z) + bitCount(tiles.w)) != rect.size.x * rect.size.y;
    uvec2 last = rect.size - 1u;
    return rect.first.x | rect.first.y << RECT_PLACE_BITS | last.x << 2 * RECT_PLACE_BITS
        | last.y << 2 * RECT_PLACE_BITS + RECT_SIZE_BITS | (masked ? RECT_MASKED : 0u);
}

// True where the mask says more than the word.
bool needs_mask(uint word) {
    return word != RECT_NONE && word >= RECT_MASKED;
}

// The rectangle of a word that is neither RECT_LARGE nor RECT_NONE.
Rect rect_of_word(uint word) {
    uvec2 first = uvec2(bitfieldExtract(word, 0, RECT_PLACE_BITS), bitfieldExtract(word, RECT_PLACE_BITS, RECT_PLACE_BITS));
    uvec2 last = uvec2(bitfieldExtract(word, 2 * RECT_PLACE_BITS, RECT_SIZE_BITS),
        bitfieldExtract(word, 2 * RECT_PLACE_BITS + RECT_SIZE_BITS, RECT_SIZE_BITS));
    return Rect(first, last + 1u);
}

// Where the word of a splat is.
#define RECT_WORD(tile_masks, splat) tile_masks.at[CUT.scene.gaussian_count + (splat) / 4u][(splat) % 4u]

#endif
