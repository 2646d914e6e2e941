// The coarse lists of COARSE_GROUP_SIZE consecutive splats in the order of depth, which a workgroup of as many invocations writes.
// Included after `counts` and these buffers are declared: `order`, `tile_masks`, `tile_splats`, and the constant RECTS.
#ifndef RARA_COARSE_LISTS
#define RARA_COARSE_LISTS
#include "coarse.glsl"
#include "rects.glsl"

const uint GROUP_WORDS = COARSE_GROUP_SIZE / 32u;
// The bits of the workgroup's splats: a word after the other, of all rows and columns of cells.
shared uint bits[GROUP_WORDS * MOST_CELLS];

Rect rect_of(uint splat) {
    if (RECTS) {
        uint word = RECT_WORD(tile_masks, splat);
        return word == RECT_NONE ? NO_RECT : word == RECT_LARGE ? rect_of_bounds(tile_masks.at[splat].zw) : rect_of_word(word);
    }
    uvec4 tiles = tile_masks.at[splat];
    return tiles.y == 0u ? rect_of_mask(tiles.x, tiles.zw) : rect_of_bounds(tiles.zw);
}

void set_bits(uint begin, uint bit, uvec2 cells) {
    for (uint cell = cells.x; cell <= cells.y; cell++) {
        atomicOr(bits[begin + cell], bit);
    }
}

uint coarse_words() {
    return (counts.at[0].mesh_groups.w + 31u) / 32u;
}

void write_coarse_lists(uint group) {
    uint local = gl_LocalInvocationIndex;
    uint words = coarse_words();
    uint side = EYE.room.cell_side;
    uvec2 cells = cell_counts(side);
    uint stride = cells.x + cells.y;
    for (uint i = local; i < GROUP_WORDS * stride; i += COARSE_GROUP_SIZE) {
        bits[i] = 0u;
    }
    barrier();
    uint place = group * COARSE_GROUP_SIZE + local;
    Rect rect = NO_RECT;
    if (place < counts.at[0].mesh_groups.w) {
        uint splat = order.at[place];
        tile_splats.at[place] = splat;
        rect = rect_of(splat);
    }
    if (rect.size.x != 0u) {
        uvec2 first = rect.first / side;
        uvec2 last = (rect.first + rect.size - 1u) / side;
        uint begin = local / 32u * stride;
        uint bit = 1u << (local & 31u);
        set_bits(begin, bit, uvec2(first.y, last.y));
        set_bits(begin + cells.y, bit, uvec2(first.x, last.x));
    }
    barrier();
    for (uint i = local; i < GROUP_WORDS * stride; i += COARSE_GROUP_SIZE) {
        uint word = group * GROUP_WORDS + i % GROUP_WORDS;
        if (word < words) {
            uint begin = cell_bits_place(words) + i / GROUP_WORDS * words;
            tile_splats.at[begin + word] = bits[i % GROUP_WORDS * stride + i / GROUP_WORDS];
        }
    }
}

#endif
