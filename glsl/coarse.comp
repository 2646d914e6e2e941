#version 460
#extension GL_GOOGLE_include_directive : require
// The last step of binning writes coarse lists where those of the tiles have no room, one invocation a splat in the order of depth.
// All tiles count as filled then.
#include "coarse.glsl"
#include "rects.glsl"

layout(local_size_x = COARSE_GROUP_SIZE) in;

// True for the pipelines for GPUs, which know most splats' tiles by a rectangle and list the tiles.
layout(constant_id = 0) const bool RECTS = false;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, order)
BUFFER(readonly, 3, uvec4, tile_masks)
BUFFER(writeonly, 4, uint, tile_splats)
BUFFER(writeonly, 5, uint, tile_begins)
BUFFER(writeonly, 6, uint, tile_list)

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

void main() {
    uint local = gl_LocalInvocationIndex;
    uint splats = counts.at[0].mesh_groups.w;
    uint words = (splats + 31u) / 32u;
    uint side = EYE.room.cell_side;
    uvec2 cells = cell_counts(side);
    uint stride = cells.x + cells.y;
    for (uint i = local; i < GROUP_WORDS * stride; i += COARSE_GROUP_SIZE) {
        bits[i] = 0u;
    }
    barrier();
    uint place = LINEAR_GROUP * COARSE_GROUP_SIZE + local;
    Rect rect = NO_RECT;
    if (place < splats) {
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
        uint word = LINEAR_GROUP * GROUP_WORDS + i % GROUP_WORDS;
        if (word < words) {
            uint begin = cell_bits_place(words) + i / GROUP_WORDS * words;
            tile_splats.at[begin + word] = bits[i % GROUP_WORDS * stride + i / GROUP_WORDS];
        }
    }
    uint invocations = (splats + COARSE_GROUP_SIZE - 1u) / COARSE_GROUP_SIZE * COARSE_GROUP_SIZE;
    for (uint tile = place; tile < EYE.tiles.tile_count; tile += invocations) {
        tile_begins.at[tile] = tile;
        if (RECTS) {
            tile_list.at[tile] = tile;
        }
    }
    if (place == 0u) {
        tile_begins.at[EYE.tiles.tile_count] = EYE.tiles.tile_count;
        tile_begins.at[cell_side_place()] = side;
        tile_begins.at[cell_words_place()] = words;
    }
}
